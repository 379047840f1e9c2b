// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { Cell, Grid } from "../src/grid";
import { Scorer } from "../src/score";
import { compose, identity, inverse } from "../src/se2";
import { randomNumbers, randomPose } from "./random";

/** Free rooms behind walls, at places that do not repeat. */
function rooms(): Grid {
  const size = 120;
  const cells = new Uint8Array(size * size).fill(Cell.free);
  for (const at of [0, 31, 70, 119]) {
    for (let i = 0; i < size; i++) cells[at * size + i] = cells[i * size + (size - 1 - at)] = Cell.occupied;
  }
  return new Grid(size, size, 0.1, { x: -3, y: 2, theta: 0.3 }, cells);
}

test("a map on itself fits in full, wherever both lie", () => {
  const grid = rooms();
  const random = randomNumbers(1);
  for (let i = 0; i < 5; i++) {
    const pose = randomPose(random);
    assert.deepEqual(new Scorer(grid).score(pose, [{ grid, pose }]), { wallsMet: 1, wallsSeen: 1, agreement: 1, overlap: 1 });
  }
});

test("the fit is best where the map belongs, and falls with every step away", () => {
  const grid = rooms();
  const scorer = new Scorer(grid);
  const pose = { x: 4, y: 5, theta: 1 };
  const at = (dx: number, theta: number) =>
    scorer.score(compose(pose, { x: dx, y: 0, theta }), [{ grid, pose }])!;
  assert.ok(at(0, 0).wallsMet > at(0.4, 0).wallsMet && at(0.4, 0).wallsMet > at(1.5, 0).wallsMet);
  assert.ok(at(0, 0).agreement > at(0.4, 0).agreement);
  assert.ok(at(0, 0).wallsMet > at(0, 0.1).wallsMet);
});

test("overlap is the share that another map knows", () => {
  const grid = rooms();
  const half = compose(grid.origin, compose({ x: 6, y: 0, theta: 0 }, inverse(grid.origin)));
  const score = new Scorer(grid).score(half, [{ grid, pose: identity }])!;
  assert.ok(Math.abs(score.overlap - 0.5) < 0.02, `${score.overlap}`);
});

test("nothing in common is no score", () => {
  const grid = rooms();
  assert.equal(new Scorer(grid).score({ x: 500, y: 0, theta: 0 }, [{ grid, pose: identity }]), null);
  assert.equal(new Scorer(grid).score(identity, []), null);
  const nothing = new Grid(0, 0, 0.1, identity, new Uint8Array(0));
  assert.equal(new Scorer(nothing).score(identity, [{ grid, pose: identity }]), null);
});

test("what any of several maps knows counts", () => {
  const grid = rooms();
  const far = { grid, pose: { x: 500, y: 0, theta: 0 } };
  assert.deepEqual(new Scorer(grid).score(identity, [far, { grid, pose: identity }]), { wallsMet: 1, wallsSeen: 1, agreement: 1, overlap: 1 });
});
