// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { type SE2, apply, compose, identity, inverse, moved, normalizeAngle } from "../src/se2";
import { randomNumbers, randomPose } from "./random";

function assertNear(a: SE2, b: SE2): void {
  assert.ok(Math.hypot(a.x - b.x, a.y - b.y) < 1e-9, `${JSON.stringify(a)} is not ${JSON.stringify(b)}`);
  assert.ok(Math.abs(normalizeAngle(a.theta - b.theta)) < 1e-9, `${a.theta} is not ${b.theta}`);
}

test("a transform and its inverse cancel out", () => {
  const random = randomNumbers(1);
  for (let i = 0; i < 200; i++) {
    const t = randomPose(random);
    assertNear(compose(t, inverse(t)), identity);
    assertNear(compose(inverse(t), t), identity);
  }
});

test("composition applies the right transform first", () => {
  const random = randomNumbers(2);
  for (let i = 0; i < 200; i++) {
    const [a, b, p] = [randomPose(random), randomPose(random), randomPose(random)];
    const together = apply(compose(a, b), p);
    const inTurn = apply(a, apply(b, p));
    assert.ok(Math.hypot(together.x - inTurn.x, together.y - inTurn.y) < 1e-9);
  }
  const quarter = apply({ x: 1, y: 2, theta: Math.PI / 2 }, { x: 1, y: 0 });
  assert.ok(Math.hypot(quarter.x - 1, quarter.y - 3) < 1e-12, "turns counter-clockwise, then shifts");
});

test("angles are kept in (-pi, pi]", () => {
  assert.equal(normalizeAngle(Math.PI), Math.PI);
  assert.equal(normalizeAngle(-Math.PI), Math.PI);
  const random = randomNumbers(3);
  for (let i = 0; i < 200; i++) {
    const angle = (random() - 0.5) * 100;
    const normal = normalizeAngle(angle);
    assert.ok(normal > -Math.PI && normal <= Math.PI);
    assert.ok(Math.abs(Math.sin(normal) - Math.sin(angle)) < 1e-9 && Math.abs(Math.cos(normal) - Math.cos(angle)) < 1e-9);
  }
});

test("moving about a pivot leaves the pivot where the shift puts it", () => {
  const random = randomNumbers(4);
  for (let i = 0; i < 200; i++) {
    const [t, pivot] = [randomPose(random), randomPose(random)];
    const [dx, dy, turn] = [random(), random(), random()];
    const after = moved(t, dx, dy, turn, pivot);
    const p = apply(t, pivot);
    const q = apply(after, pivot);
    assert.ok(Math.hypot(q.x - p.x - dx, q.y - p.y - dy) < 1e-9);
    assert.ok(Math.abs(normalizeAngle(after.theta - t.theta - turn)) < 1e-9);
  }
});
