// SPDX-License-Identifier: Apache-2.0
import type { Component, Join, Report } from "../src/report";
import { type SE2, compose, identity, inverse } from "../src/se2";

export function join(fixed: number, moving: number, transform: SE2, more: Partial<Join> = {}): Join {
  return {
    fixed, moving, transform, outcome: "accepted", reason: null, by_themselves: { verdict: "accepted", reason: null }, probability: 1,
    acceptance_index: 1, agreement: 1, disagreement: 0, overlap: 1, hypotheses: [], ...more,
  };
}

/** A report of maps of which nothing is known, in one merged map at `poses`, with a true join of each two. */
export function reportOf(poses: SE2[], joins: Join[] = trueJoins(poses)): Report {
  const grid = { width: 0, height: 0, resolution: 1, origin: identity, cells: "" };
  const component: Component = {
    ...grid, file: "merged.yaml", frame: 0, agreeing: 0, conflicting: 0,
    members: poses.map((transform, map) => ({ map, transform, probability: null, sd: null })),
  };
  return {
    version: "", live: false, merge: "0123456789abcdef", maps: poses.map((_, i) => ({ ...grid, name: `${i}.yaml`, color: "#000000" })), components: [component],
    joins, refused: { count: 0, rows: [] }, left_out: [], open_ways: [],
  };
}

function trueJoins(poses: SE2[]): Join[] {
  return poses.flatMap((pose, moving) => poses.slice(0, moving).map((on, fixed) => join(fixed, moving, compose(inverse(on), pose))));
}

/** The same merge with its maps in another order: map i of it is map `order[i]` of the report. */
export function reordered(report: Report, order: number[]): Report {
  const now = (map: number) => order.indexOf(map);
  return {
    ...report, merge: `${report.merge} as ${order.join()}`,
    maps: order.map((then, i) => ({ ...report.maps[then], color: report.maps[i].color })),
    components: report.components.map((component) => ({
      ...component, frame: component.frame === null ? null : now(component.frame),
      members: component.members.map((member) => ({ ...member, map: now(member.map) })),
    })),
    joins: report.joins.map((one) => {
      const [fixed, moving] = [now(one.fixed), now(one.moving)];
      // The map that comes first is the fixed one.
      return fixed <= moving ? { ...one, fixed, moving } : {
        ...one, fixed: moving, moving: fixed, transform: inverse(one.transform),
        hypotheses: one.hypotheses.map((way) => ({ ...way, transform: inverse(way.transform) })),
      };
    }),
    left_out: report.left_out.map((one) => ({ ...one, map: now(one.map) })),
    open_ways: report.open_ways.map((way) => ({ ...way, fixed: now(way.fixed), moving: now(way.moving) })),
  };
}
