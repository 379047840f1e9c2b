// SPDX-License-Identifier: Apache-2.0
import { readableOn } from "./badge";
import { svg } from "./dom";
import { joinTitle } from "./join_graph";
import type { Join, Outcome } from "./report";
import type { State } from "./state";
import { flat } from "./text";

const size = 320;

/**
 * A square for each pair of maps, at its row and column: what becomes of a graph when many maps are joined to most of the
 * others. The fuller a square, the more do the two maps have in common; an empty place was refused, or hidden.
 */
export function joinMatrix(state: State, outcomes: Set<Outcome>, choose: (join: number) => void): SVGSVGElement {
  const { report } = state;
  const order = orderOf(state);
  const step = size / order.length;
  const placeOf = new Map(order.map((map, i) => [map, i]));
  const cells = report.joins.flatMap((join, index) => {
    const [column, row] = [placeOf.get(join.fixed)!, placeOf.get(join.moving)!].sort((a, b) => a - b);
    return outcomes.has(join.outcome) ? [cellOf(state, join, index, column * step, row * step, step, choose)] : [];
  });
  const lines = order.flatMap((_, i) => [
    svg("line", { class: "rule", x1: 0, x2: i * step, y1: (i + 0.5) * step, y2: (i + 0.5) * step }),
    svg("line", { class: "rule", x1: (i + 0.5) * step, x2: (i + 0.5) * step, y1: (i + 1) * step, y2: size }),
  ]);
  return svg("svg", {
    viewBox: `0 0 ${size} ${size}`, class: "join-graph", role: "group",
    "aria-label": "Joins between maps, a square for each; the table below lists the same",
  }, ...lines, ...cells, ...order.map((map, i) => labelOf(state, map, i * step, step)));
}

/** Those of a component beside each other, then those that were left out. */
function orderOf(state: State): number[] {
  const { components, left_out: leftOut } = state.report;
  return [...components.flatMap((component) => component.members.map(({ map }) => map)), ...leftOut.map(({ map }) => map)];
}

function cellOf(
  state: State, join: Join, index: number, x: number, y: number, step: number, choose: (join: number) => void): SVGGElement {
  const { id } = state.scene;
  const chosen = id.kind === "join" && id.join === index;
  const room = step - 2;
  const side = room * Math.sqrt(0.15 + 0.85 * Math.min(1, Math.max(0, join.overlap)));
  const at = (width: number) => ({ x: x + (step - width) / 2, y: y + (step - width) / 2, width, height: width });
  const cell = svg("g", {
    class: `edge ${join.outcome}${chosen ? " chosen" : ""}`, "data-join": index, click: () => choose(index),
  },
  svg("title", {}, joinTitle(state, join)), svg("rect", { ...at(step), class: "reach" }),
  svg("rect", { ...at(side), class: "cell", rx: Math.min(3, side / 6) }));
  cell.addEventListener("pointerenter", () => state.point(join.moving));
  cell.addEventListener("pointerleave", () => state.point(null));
  return cell;
}

/** On the diagonal, where a map's row and column meet. */
function labelOf(state: State, map: number, at: number, step: number): SVGGElement {
  const { color } = state.looks[map];
  const label = svg("g", { class: "node" },
    svg("title", {}, flat(state.report.maps[map].name)),
    svg("rect", { x: at + 0.5, y: at + 0.5, width: step - 1, height: step - 1, rx: Math.min(4, step / 5), fill: color }),
    svg("text", {
      x: at + step / 2, y: at + step / 2, fill: readableOn(color), "text-anchor": "middle", "dominant-baseline": "central",
      "font-size": Math.min(12, 0.55 * step),
    }, String(map + 1)));
  label.addEventListener("pointerenter", () => state.point(map));
  label.addEventListener("pointerleave", () => state.point(null));
  return label;
}
