// SPDX-License-Identifier: Apache-2.0
import { parseColor } from "./color";
import { h, name } from "./dom";
import type { State } from "./state";

/** Black or white, whichever reads better on a colour (by its relative luminance, WCAG 2). */
export function readableOn(color: string): string {
  const [red, green, blue] = parseColor(color).map((channel) => {
    const c = channel / 255;
    return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue > 0.179 ? "#000" : "#fff";
}

/** A map's number in its colour: what tells maps apart for those who cannot tell the colours. */
export function badge(state: State, map: number): HTMLElement {
  const { color } = state.looks[map];
  const element = h("span", { class: "badge", "aria-hidden": "true" }, String(map + 1));
  element.style.background = color;
  element.style.color = readableOn(color);
  return element;
}

/** The badge with the map's name; pointing at it shows where the map lies. */
export function mapLabel(state: State, map: number): HTMLElement {
  const element = h("span", { class: "map-label" }, badge(state, map), name(state.names[map], state.report.maps[map].name));
  element.addEventListener("pointerenter", () => state.point(map));
  element.addEventListener("pointerleave", () => state.point(null));
  return element;
}

/** Makes an element show where a map lies while the keyboard is on something in it: what pointing at the map's label does. */
export function focusPointsOut<E extends HTMLElement>(element: E, state: State, map: number): E {
  element.addEventListener("focusin", (event) => {
    if ((event.target as Element).matches(":focus-visible")) state.point(map);
  });
  element.addEventListener("focusout", () => state.point(null));
  return element;
}
