// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { type SE2, compose } from "../src/se2";
import { mergedPose, offsetOf, witnessesOf } from "../src/witnesses";
import { randomNumbers, randomPose } from "./random";
import { join, reportOf } from "./reports";

test("whatever map joins lead over, true ones lead to the same place", () => {
  const random = randomNumbers(11);
  const poses = Array.from({ length: 6 }, () => randomPose(random));
  const report = reportOf(poses);
  for (const one of report.joins) {
    const witnesses = witnessesOf(report, one, { x: 3, y: -2 });
    assert.deepEqual(new Set(witnesses.map(({ map }) => map)),
      new Set([0, 1, 2, 3, 4, 5].filter((map) => map !== one.fixed && map !== one.moving)));
    for (const { offset } of witnesses) assert.ok(offset.distance < 1e-9 && offset.angle < 1e-9);
    const { distance, angle } = offsetOf(mergedPose(report, one)!, one.transform, { x: 3, y: -2 });
    assert.ok(distance < 1e-9 && angle < 1e-9);
  }
});

test("a join that lies off is told by as much", () => {
  const at = { x: 4, y: 1 };
  const off: SE2 = { x: 0.3, y: -0.4, theta: 0 };
  const poses = [{ x: 0, y: 0, theta: 0 }, { x: 5, y: 0, theta: 1 }, { x: 0, y: 7, theta: -2 }];
  const report = reportOf(poses);
  const [first] = report.joins;
  first.transform = compose(off, first.transform);
  const [{ map, offset }] = witnessesOf(report, first, at);
  assert.equal(map, 2);
  assert.ok(Math.abs(offset.distance - 0.5) < 1e-9 && offset.angle < 1e-9);
});

test("the nearest witness comes first, and joins that are not used are none", () => {
  const poses = Array.from({ length: 5 }, () => ({ x: 0, y: 0, theta: 0 }));
  const report = reportOf(poses);
  const between = (a: number, b: number) => report.joins.find((one) => one.fixed === a && one.moving === b)!;
  between(0, 2).transform = { x: 3, y: 0, theta: 0 };
  between(0, 3).transform = { x: 1, y: 0, theta: 0 };
  between(1, 4).outcome = "refused";
  assert.deepEqual(witnessesOf(report, between(0, 1), { x: 0, y: 0 }).map(({ map, offset }) => [map, offset.distance]), [[3, 1], [2, 3]]);
});

test("angles are told the shorter way", () => {
  const { angle } = offsetOf({ x: 0, y: 0, theta: 3.1 }, { x: 0, y: 0, theta: -3.1 }, { x: 0, y: 0 });
  assert.ok(Math.abs(angle - (2 * Math.PI - 6.2)) < 1e-12);
});

test("maps of different merged maps have no pose to each other", () => {
  const report = reportOf([{ x: 0, y: 0, theta: 0 }]);
  assert.equal(mergedPose(report, join(0, 1, { x: 0, y: 0, theta: 0 })), null);
});
