// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { type HandPoses, carriedOver, keptView } from "../src/kept";
import { type SharedView, defaultView } from "../src/link";
import type { Report } from "../src/report";
import { type SE2, apply, compose, inverse } from "../src/se2";
import { reordered, reportOf } from "./reports";

const pose = (x: number, y = 0, theta = 0): SE2 => ({ x, y, theta });
const poses = [pose(0), pose(5, 1, 0.5), pose(-3, 2, -1)];
const report = reportOf(poses);

/** As the next page finds it. */
const carried = (from: Report, view: SharedView, hand: HandPoses, to: Report) =>
  carriedOver(to, JSON.parse(JSON.stringify(keptView(from, view, hand))) as ReturnType<typeof keptView>);

function near(a: SE2, b: SE2): void {
  assert.ok(Math.hypot(a.x - b.x, a.y - b.y, a.theta - b.theta) < 1e-9, `${JSON.stringify(a)} is not ${JSON.stringify(b)}`);
}

test("the same merge is shown as it was, to the bit", () => {
  const view: SharedView = {
    ...defaultView(report), scene: { kind: "join", join: 1, hypothesis: -1 }, center: { x: 1 / 3, y: 2 }, metres: 7, tab: "hand", merged: 0.5,
    maps: new Map([[0, 0], [2, 0.25]]), colors: new Map([[1, "#123456"]]), ruler: { from: { x: 0.1, y: 2 }, to: { x: 3, y: 4 } },
  };
  const hand: HandPoses = [[{ kind: "component", component: 0 }, new Map([[1, pose(1 / 3, 2, 0.7)]])], [{ kind: "map", map: 2 }, new Map([[0, pose(1)]])],
    [{ kind: "join", join: 1, hypothesis: -1 }, new Map([[2, pose(8)]])]];
  assert.deepEqual(carried(report, view, hand, report), { view, hand });
});

test("what was done to a map stays with it when maps are numbered otherwise", () => {
  const now = reordered(report, [1, 2, 0]);
  const view: SharedView = {
    ...defaultView(report), scene: { kind: "map", map: 1 }, maps: new Map([[0, 0]]), colors: new Map([[0, report.maps[0].color], [2, "#123456"]]),
  };
  const hand: HandPoses = [[{ kind: "component", component: 0 }, new Map([[0, pose(9)]])], [{ kind: "map", map: 2 }, new Map([[1, pose(1)]])]];
  const there = carried(report, view, hand, now);
  assert.deepEqual(there.view.scene, { kind: "map", map: 0 });
  assert.deepEqual(there.view.maps, new Map([[2, 0]]));
  assert.deepEqual(there.view.colors, new Map([[1, "#123456"]]), "those that nobody chose are the next report's");
  assert.deepEqual(there.hand, [[{ kind: "component", component: 0 }, new Map([[2, pose(9)]])], [{ kind: "map", map: 1 }, new Map([[0, pose(1)]])]]);
});

test("poses, and the place that is looked at, go along into another frame", () => {
  // The first map is gone, and its frame with it.
  const T = inverse(poses[1]);
  const gone = reordered(report, [1, 2]);
  const now = { ...gone, joins: [], components: [{ ...gone.components[0], frame: 0, members: gone.components[0].members
    .filter(({ map }) => map >= 0).map((member) => ({ ...member, transform: compose(T, member.transform) })) }] };
  const view = { ...defaultView(report), center: { x: 4, y: 4 }, metres: 3, ruler: { from: { x: 1, y: 0 }, to: { x: 2, y: 0 } } };
  const there = carried(report, view, [[{ kind: "component", component: 0 }, new Map([[2, pose(6, 6, 1)], [0, pose(1)]])]], now);
  const [[, laid]] = there.hand;
  assert.deepEqual([...laid.keys()], [1], "what was done to a map that is gone is gone");
  near(laid.get(1)!, compose(T, pose(6, 6, 1)));
  for (const [then, moved] of [[view.center, there.view.center!], [view.ruler.to, there.view.ruler!.to]] as const) {
    near({ ...apply(T, then), theta: 0 }, { ...moved, theta: 0 });
  }
});

test("a group that parts is followed by the pose to where most of it is, and a scene that is no more is left", () => {
  const [whole] = report.components;
  const now: Report = {
    ...report, merge: "another", joins: [],
    components: [{ ...whole, members: [] }, { ...whole, members: whole.members.slice(0, 2) }, { ...whole, frame: 2, members: whole.members.slice(2) }],
  };
  const there = carried(report, { ...defaultView(report), scene: { kind: "join", join: 0, hypothesis: -1 }, center: { x: 1, y: 1 }, metres: 2 },
    [[{ kind: "component", component: 0 }, new Map([[1, pose(3)]])]], now);
  assert.deepEqual(there.hand, [[{ kind: "component", component: 1 }, new Map([[1, pose(3)]])]]);
  assert.deepEqual(there.view.scene, { kind: "component", component: 0 });
  assert.equal(there.view.center, null, "a place of a scene that is no more");
});

test("a join that is turned round, or has no way, is shown still", () => {
  const ways = [pose(1, 2, 0.3), pose(4, -1, 2)].map((transform) => ({ transform, score: 1, probability: 0.5 }));
  const [one, ...others] = report.joins;
  const ambiguous = { ...report, joins: [{ ...one, transform: ways[0].transform, hypotheses: ways }, ...others] };
  const view: SharedView = { ...defaultView(report), scene: { kind: "join", join: 0, hypothesis: 1 }, center: { x: 3, y: 1 }, metres: 4 };
  const hand: HandPoses = [[view.scene, new Map([[1, pose(5, 5, 1)]])]];
  const turned = carried(ambiguous, view, hand, reordered(ambiguous, [1, 0, 2]));
  assert.deepEqual(turned.view.scene, view.scene);
  const T = inverse(ways[1].transform);
  near({ ...apply(T, view.center!), theta: 0 }, { ...turned.view.center!, theta: 0 });
  assert.deepEqual(turned.hand.map(([id]) => id), [view.scene]);
  near(turned.hand[0][1].get(0)!, compose(T, pose(5, 5, 1)));

  const wayless = { ...report, joins: [{ ...one, outcome: "refused" as const, probability: 0 }, ...others] };
  const scene = { kind: "join" as const, join: 0, hypothesis: -1 };
  const laid: HandPoses = [[scene, new Map([[1, pose(5, 5, 1)]])]];
  assert.deepEqual(carried(wayless, { ...view, scene }, laid, wayless), { view: { ...view, scene }, hand: laid });
  const both = carried(wayless, { ...view, scene }, laid, reordered(wayless, [1, 0, 2]));
  assert.deepEqual(both.view.scene, scene);
  assert.deepEqual(carried(wayless, { ...view, scene }, [], ambiguous).view.scene, { ...scene, hypothesis: 0 }, "it has a way now");
});

test("maps of one name are told apart", () => {
  const twins = { ...report, maps: report.maps.map((map) => ({ ...map, name: "map.yaml" })) };
  const view = { ...defaultView(twins), maps: new Map([[0, 0.5], [2, 0]]) };
  assert.deepEqual(carried(twins, view, [], twins).view.maps, view.maps);
});
