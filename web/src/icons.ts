// SPDX-License-Identifier: Apache-2.0
import { svg } from "./dom";

/** Lines of a square of 24 by 24, as SVG's path has them. */
const shapes = {
  plus: "M12 5v14M5 12h14",
  minus: "M5 12h14",
  all: "M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5",
  grid: "M4 9h16M4 15h16M9 4v16M15 4v16",
  ruler: "M3 15.5 15.5 3 21 8.5 8.5 21zM6.5 12l2 2M9.5 9l3 3M12.5 6l2 2",
  picture: "M12 4v10M8 10.5l4 4 4-4M4 17v3h16v-3",
  link: "M10 14a4 4 0 0 0 6 .4l3-3a4 4 0 0 0-5.7-5.7l-1.5 1.5M14 10a4 4 0 0 0-6-.4l-3 3a4 4 0 0 0 5.7 5.7l1.5-1.5",
  help: "M9 9a3 3 0 1 1 4.5 2.600c-1 .6-1.5 1.200-1.5 2.400M12 17.5v.5",
} as const;

export type Icon = keyof typeof shapes;

export function icon(name: Icon): SVGSVGElement {
  return svg("svg", { viewBox: "0 0 24 24", class: "icon", "aria-hidden": "true" }, svg("path", { d: shapes[name] }));
}
