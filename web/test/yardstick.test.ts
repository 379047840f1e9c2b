// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { Cell, Grid } from "../src/grid";
import { Scorer } from "../src/score";
import { type SE2, identity } from "../src/se2";
import { type Yardstick, laid, yardstickOf } from "../src/yardstick";
import { randomNumbers } from "./random";

/** Ten metres by eight with walls around, and some within. */
function room(seed: number): Grid {
  const random = randomNumbers(seed);
  const width = 100, height = 80;
  const cells = new Uint8Array(width * height).fill(Cell.free);
  for (let i = 0; i < width; i++) cells[i] = cells[(height - 1) * width + i] = Cell.occupied;
  for (let j = 0; j < height; j++) cells[j * width] = cells[j * width + width - 1] = Cell.occupied;
  for (let k = 0; k < 6; k++) {
    const row = Math.floor(random() * height);
    for (let i = 20; i < 50; i++) cells[row * width + i] = Cell.occupied;
  }
  return new Grid(width, height, 0.1, identity, cells);
}

function run(grid: Grid, others: { grid: Grid; pose: SE2 }[], members: { grid: Grid; pose: SE2 }[]): Yardstick {
  const work = yardstickOf(new Scorer(grid), grid, others, members);
  for (;;) {
    const step = work.next();
    if (step.done) return step.value;
  }
}

test("maps that lie on each other meet their walls, and one that is laid anywhere does not", () => {
  const grid = room(3);
  const two = [{ grid, pose: identity }, { grid, pose: identity }];
  const { joined, chance } = run(grid, two, two);
  assert.deepEqual(joined, { least: 1, most: 1 });
  assert.ok(chance !== null && chance > 0 && chance < 0.6, `${chance}`);
  assert.deepEqual(run(grid, two, two), { joined, chance }, "the same each time");
});

test("without a merged map there is chance alone, and without anything there is nothing", () => {
  const grid = room(4);
  assert.equal(run(grid, [{ grid, pose: identity }], []).joined, null);
  assert.deepEqual(run(grid, [], []), { joined: null, chance: null });
  const two = [{ map: 0, T_scene_map: identity }, { map: 1, T_scene_map: identity }];
  assert.deepEqual(laid(two, ({ map }) => (map === 0 ? grid : null)), [{ grid, pose: identity }]);
});

test("a place where hardly a wall is seen is none by which chance is told", () => {
  const grid = room(5);
  const dot = new Grid(4, 4, 0.1, identity, new Uint8Array(16).fill(Cell.occupied));
  assert.equal(run(grid, [{ grid: dot, pose: identity }], []).chance, null, "a dot sees too little of any place");
});
