// SPDX-License-Identifier: Apache-2.0
import { h } from "./dom";

const keys: [string, string][] = [
  ["arrows", "move the view, or the map in hand by a cell (Shift: ten)"],
  ["+ and −, wheel", "zoom"],
  ["0", "show all"],
  ["1 … 9", "show or hide a map"],
  ["m, a", "show the merged map or the maps in it; show or hide what they agree on"],
  ["p", "show or hide the plan, if the merge has one"],
  ["r", "measure: Enter, a click or a drag puts the ends"],
  ["g", "show or hide the metre grid"],
  ["q, e", "turn the map in hand by half a degree (Shift: five)"],
  ["Enter, Esc", "refine the map in hand, let it go"],
  ["?", "this list"],
];

/** The keys of the stage, in a dialog. */
export function helpDialog(): HTMLDialogElement {
  const dialog = h("dialog", { class: "help", "aria-labelledby": "help-title" },
    h("h2", { id: "help-title" }, "Keys"),
    h("dl", {}, ...keys.flatMap(([key, meaning]) => [h("dt", {}, key), h("dd", {}, meaning)])),
    h("p", { class: "soft" }, "They work while the map has the focus. With mouse or fingers: drag to move, wheel or pinch to zoom."),
    h("form", { method: "dialog" }, h("button", {}, "Close")));
  return dialog;
}
