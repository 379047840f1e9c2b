// SPDX-License-Identifier: Apache-2.0
import { readableOn } from "./badge";
import { svg } from "./dom";
import { probability } from "./numbers";
import { type Join, type Outcome, hasWay } from "./report";
import type { State } from "./state";
import { flat } from "./text";

const size = 320;
const middle = size / 2;

/** Maps in a circle, those of a component beside each other, and a line for each join. */
export function joinGraph(state: State, outcomes: Set<Outcome>, choose: (join: number) => void): SVGSVGElement {
  const { report } = state;
  const spots = spotsOf(state);
  const lines = report.joins
    .map((join, index) => ({ join, index }))
    .filter(({ join }) => outcomes.has(join.outcome))
    .sort((a, b) => rank(b.join) - rank(a.join))
    .map(({ join, index }) => lineOf(state, join, index, spots, choose));
  return svg("svg", {
    viewBox: `0 0 ${size} ${size}`, class: "join-graph", role: "group",
    "aria-label": "Joins between maps; the table below lists the same",
  }, ...lines, ...report.maps.map((_, map) => nodeOf(state, map, spots[map])));
}

/** What is drawn later lies above. */
function rank(join: Join): number {
  return ["accepted", "known", "rescued", "rejected", "refused"].indexOf(join.outcome);
}

function spotsOf(state: State): { x: number; y: number }[] {
  const { components, left_out: leftOut, maps } = state.report;
  const groups = [...components.map((component) => component.members.map((member) => member.map)),
    ...leftOut.map(({ map }) => [map])];
  const order = groups.flat();
  const radius = maps.length === 1 ? 0 : middle - 22;
  const spots: { x: number; y: number }[] = maps.map(() => ({ x: middle, y: middle }));
  // A gap of half a place between groups.
  const gaps = groups.length > 1 ? 0.5 : 0;
  const total = order.length + gaps * groups.length;
  let at = 0;
  for (const group of groups) {
    for (const map of group) {
      const angle = (2 * Math.PI * at) / total - Math.PI / 2;
      spots[map] = { x: middle + radius * Math.cos(angle), y: middle + radius * Math.sin(angle) };
      at++;
    }
    at += gaps;
  }
  return spots;
}

/** "robot_1.yaml and robot_2.yaml: accepted, probability 0.98". */
export function joinTitle(state: State, join: Join): string {
  const what = hasWay(join) ? `${join.outcome}, probability ${probability(join.probability)}` : "nothing to compare";
  return `${flat(state.names[join.fixed])} and ${flat(state.names[join.moving])}: ${what}`;
}

function lineOf(
  state: State, join: Join, index: number, spots: { x: number; y: number }[], choose: (join: number) => void): SVGGElement {
  const a = spots[join.fixed];
  const b = spots[join.moving];
  const ends = { x1: a.x, y1: a.y, x2: b.x, y2: b.y };
  const { id } = state.scene;
  const chosen = id.kind === "join" && id.join === index;
  return svg("g", {
    class: `edge ${join.outcome}${chosen ? " chosen" : ""}`, "data-join": index, click: () => choose(index),
  },
  svg("title", {}, joinTitle(state, join)), svg("line", { ...ends, class: "reach" }), svg("line", { ...ends, class: "line" }));
}

function nodeOf(state: State, map: number, spot: { x: number; y: number }): SVGGElement {
  const { color } = state.looks[map];
  const radius = state.report.maps.length > 24 ? 8 : 12;
  const node = svg("g", { class: "node" },
    svg("title", {}, flat(state.report.maps[map].name)),
    svg("circle", { cx: spot.x, cy: spot.y, r: radius, fill: color }),
    svg("text", {
      x: spot.x, y: spot.y, fill: readableOn(color), "text-anchor": "middle", "dominant-baseline": "central",
      "font-size": radius,
    }, String(map + 1)));
  node.addEventListener("pointerenter", () => state.point(map));
  node.addEventListener("pointerleave", () => state.point(null));
  return node;
}
