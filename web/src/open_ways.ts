// SPDX-License-Identifier: Apache-2.0
import { focusPointsOut, mapLabel } from "./badge";
import { h } from "./dom";
import { describe } from "./formats";
import { probability } from "./numbers";
import type { OpenWay } from "./report";
import type { SE2 } from "./se2";
import type { State } from "./state";
import { moreNote, mostRows } from "./search";

type Place = (map: number, on: number, T_on_map: SE2) => void;

/** Ways that are too likely to be passed over, and not sure enough to be taken. Null if there are none. */
export function openWays(state: State, ways: OpenWay[], placeByHand: Place): HTMLElement | null {
  if (ways.length === 0) return null;
  return h("section", { class: "open-ways left-out" },
    h("h3", {}, "Perhaps"),
    h("p", { class: "soft" }, "May lie so with what they are part of. Not sure enough, or several ways are as good."),
    h("ul", {}, ...ways.slice(0, mostRows).map((way) => itemOf(state, way, placeByHand))),
    moreNote(ways.length, "such way"));
}

function itemOf(state: State, way: OpenWay, placeByHand: Place): HTMLElement {
  return focusPointsOut(h("li", {},
    h("div", {}, mapLabel(state, way.moving), h("span", { class: "soft" }, " in the frame of "), mapLabel(state, way.fixed)),
    h("p", { class: "soft" }, `${describe(way.transform)}, probability ${probability(way.probability)}`),
    h("div", { class: "buttons" },
      h("button", { type: "button", click: () => placeByHand(way.moving, way.fixed, way.transform) }, "Place it so by hand"))), state, way.moving);
}
