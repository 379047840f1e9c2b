// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { type Rgb, disagreement, ink, sepia, white } from "../src/color";
import { type Layer, type Picture, type Square, extentOf, paint } from "../src/compose";
import { Cell, Grid } from "../src/grid";
import { type SE2, apply, identity, inverse } from "../src/se2";
import { randomGrid, randomNumbers, randomPose } from "./random";

const blue: Rgb = [0, 114, 178];
const orange: Rgb = [230, 159, 0];

function one(cell: number): Grid {
  return new Grid(1, 1, 1, identity, Uint8Array.of(cell));
}

function layer(grid: Grid, color: Rgb = blue, T_scene_map: SE2 = identity, opacity = 1): Layer {
  return { grid, color, T_scene_map, opacity };
}

/** The colour of a scene of cells of one metre at the origin. */
function pixel(picture: Partial<Picture>): number[] {
  const whole = { merged: null, layers: [], agreement: 0, ...picture };
  return [...paint(whole, { left: 0, bottom: 0, side: 1, pixels: 1 })];
}

test("a layer shows its walls in its colour and its free cells in a tint of it", () => {
  assert.deepEqual(pixel({ layers: [layer(one(Cell.occupied))] }), [...blue, 255]);
  const [red, green, bluish, alpha] = pixel({ layers: [layer(one(Cell.free))] });
  assert.ok(red > 200 && green > 220 && bluish > 235 && red < 255 && alpha === 255);
  assert.deepEqual(pixel({ layers: [layer(one(Cell.unknown))] }), [0, 0, 0, 0]);
});

test("a faded layer lets through, an invisible one takes no part", () => {
  assert.equal(pixel({ layers: [layer(one(Cell.occupied), blue, identity, 0.5)] })[3], 128);
  const picture = { layers: [layer(one(Cell.occupied)), layer(one(Cell.free), orange, identity, 0)], agreement: 1 };
  assert.deepEqual(pixel(picture), [...blue, 255]);
});

test("what two layers say alike is black or white, what they contradict each other in has its own colour", () => {
  const both = (a: number, b: number, agreement = 1) => pixel({ layers: [layer(one(a)), layer(one(b), orange)], agreement });
  assert.deepEqual(both(Cell.occupied, Cell.occupied), [...ink, 255]);
  assert.deepEqual(both(Cell.free, Cell.free), [...white, 255]);
  assert.deepEqual(both(Cell.free, Cell.occupied), [...disagreement, 255]);
  assert.deepEqual(both(Cell.unknown, Cell.occupied), [...orange, 255]);
  assert.deepEqual(both(Cell.free, Cell.occupied, 0), [...orange, 255], "a wall lies over free space");
});

test("the fewer maps say otherwise, the fainter is the contradiction", () => {
  const vote = (walls: number, frees: number) => pixel({
    layers: [...Array(walls).fill(layer(one(Cell.occupied))), ...Array(frees).fill(layer(one(Cell.free)))], agreement: 1,
  });
  assert.deepEqual(vote(2, 2), [...disagreement, 255]);
  const blueOf = (color: number[]) => color[2];
  assert.ok(blueOf(vote(1, 9)) > blueOf(vote(3, 7)) && blueOf(vote(3, 7)) > blueOf(vote(5, 5)), "from white to vermilion");
  assert.ok(blueOf(vote(9, 1)) > blueOf(vote(7, 3)) && vote(9, 1)[0] < vote(7, 3)[0], "from black to vermilion");
});

test("the merged map covers the layers", () => {
  const merged = { grid: one(Cell.occupied), opacity: 1 };
  assert.deepEqual(pixel({ merged }), [...ink, 255]);
  assert.deepEqual(pixel({ merged, layers: [layer(one(Cell.free))], agreement: 1 }), [...ink, 255]);
  const knowsNothing = { grid: one(Cell.unknown), opacity: 1 };
  assert.deepEqual(pixel({ merged: knowsNothing, layers: [layer(one(Cell.occupied))] }), [0, 0, 0, 0], "nor do they shine through");
});

test("a faded merged map lets the layers through as far as it is faded", () => {
  const half = (cell: number) => pixel({ merged: { grid: one(cell), opacity: 0.5 }, layers: [layer(one(Cell.occupied))] });
  half(Cell.free).forEach((value, i) => assert.ok(Math.abs(value - ([...blue, 255][i] + 255) / 2) <= 1));
  assert.deepEqual(half(Cell.unknown), [...blue, 128], "they fade where it knows nothing, too");
  assert.deepEqual(pixel({ merged: { grid: one(Cell.free), opacity: 0 }, layers: [layer(one(Cell.occupied))] }), [...blue, 255]);
});

test("the order of the layers does not matter", () => {
  const random = randomNumbers(5);
  const layers = [blue, orange, white].map((color) =>
    layer(randomGrid(random, 40, 30), color, randomPose(random, 2), 0.3 + 0.7 * random()));
  const square = { left: -2, bottom: -2, side: 0.1, pixels: 64 };
  const picture = { merged: null, layers, agreement: 0.7 };
  const forth = paint(picture, square);
  const back = paint({ ...picture, layers: [...layers].reverse() }, square);
  assert.ok(forth.some((value) => value > 0));
  // Sums of floats differ in the last bits.
  forth.forEach((value, i) => assert.ok(Math.abs(value - back[i]) <= 1));
});

test("every pixel shows the cell that lies at its middle, at any pose", () => {
  const random = randomNumbers(6);
  for (let i = 0; i < 20; i++) {
    const pose = randomPose(random, 3);
    const grid = randomGrid(random, 50, 40, 0.1, randomPose(random, 3));
    const square: Square = { left: -4, bottom: -3, side: 0.1, pixels: 80 };
    const out = paint({ merged: null, layers: [layer(grid, blue, pose)], agreement: 0 }, square);
    for (let j = 0; j < 80; j++) {
      for (let k = 0; k < 80; k++) {
        const p = { x: square.left + (k + 0.5) * 0.1, y: square.bottom + (80 - j - 0.5) * 0.1 };
        const cell = grid.at(apply(inverse(pose), p));
        const at = 4 * (j * 80 + k);
        const shown = out[at + 3] === 0 ? Cell.unknown : out[at + 2] === blue[2] ? Cell.occupied : Cell.free;
        assert.equal(shown, cell);
      }
    }
  }
});

test("from afar walls are still there", () => {
  const cells = new Uint8Array(64 * 64).fill(Cell.free);
  cells[20 * 64 + 20] = Cell.occupied;
  const grid = new Grid(64, 64, 0.1, identity, cells);
  const out = paint({ merged: null, layers: [layer(grid)], agreement: 0 }, { left: 0, bottom: 0, side: 1.6, pixels: 4 });
  const walls = [...out].filter((_, i) => i % 4 === 2).filter((value) => value === blue[2]).length;
  assert.equal(walls, 1);
});

test("the extent holds all corners", () => {
  const grid = new Grid(10, 20, 0.1, identity, new Uint8Array(200));
  const box = extentOf({ merged: null, layers: [layer(grid, blue, { x: 5, y: 0, theta: Math.PI / 2 })], agreement: 0 });
  for (const [value, expected] of [[box.left, 3], [box.right, 5], [box.bottom, 0], [box.top, 1]]) {
    assert.ok(Math.abs(value - expected) < 1e-9);
  }
});

test("a map that lies elsewhere than the merged map has it is seen above that", () => {
  const merged = { grid: one(Cell.free), opacity: 1 };
  assert.deepEqual(pixel({ merged, layers: [layer(one(Cell.occupied))] }), [...white, 255]);
  assert.deepEqual(pixel({ merged, layers: [{ ...layer(one(Cell.occupied)), above: true }] }), [...blue, 255]);
});

test("a plan's walls lie over floor and under the walls of maps", () => {
  const plan = { grid: one(Cell.occupied), T_scene_map: identity, opacity: 1 };
  assert.deepEqual(pixel({ plan }), [...sepia, 255]);
  assert.deepEqual(pixel({ plan, layers: [layer(one(Cell.free))] }), [...sepia, 255]);
  assert.deepEqual(pixel({ plan, layers: [layer(one(Cell.occupied))] }), [...blue, 255]);
  assert.deepEqual(pixel({ plan, merged: { grid: one(Cell.free), opacity: 1 } }), [...sepia, 255]);
  assert.deepEqual(pixel({ plan, merged: { grid: one(Cell.occupied), opacity: 1 } }), [...ink, 255]);
  assert.deepEqual(pixel({ plan: { ...plan, grid: one(Cell.free) } }), [0, 0, 0, 0], "its paper is not drawn");
  assert.equal(pixel({ plan: { ...plan, opacity: 0.5 } })[3], 128);
});

test("the extent holds the plan too", () => {
  const plan = { grid: one(Cell.occupied).scaled(3), T_scene_map: { x: -5, y: 2, theta: 0 }, opacity: 1 };
  assert.deepEqual(extentOf({ merged: null, layers: [layer(one(Cell.free))], agreement: 0, plan }), { left: -5, right: 1, bottom: 0, top: 5 });
});
