// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { placesOf } from "../src/places";
import { apply, compose, inverse } from "../src/se2";
import { randomNumbers, randomPose } from "./random";
import { join, reportOf } from "./reports";

const middle = { x: 2, y: 3 };

test("a map is placed where its most probable hypothesis has it, whichever of the two it is", () => {
  const random = randomNumbers(21);
  const [pose, good, bad] = [0, 1, 2].map(() => randomPose(random));
  const ways = (transform: (t: typeof good) => typeof good) =>
    [{ transform: transform(bad), score: 9, probability: 0.1 }, { transform: transform(good), score: 5, probability: 0.4 }];
  const placed = [{ map: 0, T_scene_map: pose }];
  for (const one of [
    join(0, 1, bad, { outcome: "refused", hypotheses: ways((t) => t) }),
    join(1, 0, inverse(bad), { outcome: "refused", hypotheses: ways(inverse) }),
  ]) {
    const places = placesOf(reportOf([pose, pose], [one]), 1, middle, placed);
    assert.deepEqual(places.map(({ probability, with: other }) => [probability, other]), [[0.4, 0], [0.1, 0]]);
    const p = apply(places[0].T_scene_map, middle);
    const q = apply(compose(pose, good), middle);
    assert.ok(Math.hypot(p.x - q.x, p.y - q.y) < 1e-9);
  }
});

test("places that several comparisons find are one", () => {
  const at = { x: 0, y: 0, theta: 0 };
  const near = { x: 0.2, y: 0.1, theta: 0.02 };
  const far = { x: 9, y: 0, theta: 0 };
  const report = reportOf([at, at, at], [join(0, 2, at, { probability: 0.3 }), join(1, 2, near, { probability: 0.2 }),
    join(1, 2, far, { probability: 0.1 })]);
  const placed = [{ map: 0, T_scene_map: at }, { map: 1, T_scene_map: at }];
  assert.deepEqual(placesOf(report, 2, middle, placed).map(({ probability }) => probability), [0.3, 0.1]);
  assert.deepEqual(placesOf(report, 2, middle, []), [], "of nothing that is seen");
});

test("maps that could not be compared have no place", () => {
  const at = { x: 0, y: 0, theta: 0 };
  const report = reportOf([at, at], [join(0, 1, at, { outcome: "refused", probability: 0 })]);
  assert.deepEqual(placesOf(report, 1, middle, [{ map: 0, T_scene_map: at }]), []);
});
