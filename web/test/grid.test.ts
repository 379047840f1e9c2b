// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { deflateSync } from "node:zlib";
import { Cell, Grid, halve, unpack } from "../src/grid";
import { apply } from "../src/se2";
import { randomGrid, randomNumbers, randomPose } from "./random";

test("a packed grid unpacks to the same cells", async () => {
  const random = randomNumbers(1);
  const grid = randomGrid(random, 31, 17);
  const packed = {
    width: 31, height: 17, resolution: 0.1, origin: grid.origin,
    cells: deflateSync(grid.finest.cells).toString("base64"),
  };
  assert.deepEqual((await unpack(packed)).finest, grid.finest);
});

test("a grid of nothing unpacks", async () => {
  const grid = await unpack({ width: 0, height: 0, resolution: 0.1, origin: { x: 0, y: 0, theta: 0 }, cells: "" });
  assert.equal(grid.at({ x: 0, y: 0 }), Cell.unknown);
  assert.equal(grid.level(5).width, 0);
});

test("damaged cells are refused", async () => {
  const whole = deflateSync(new Uint8Array(100)).toString("base64");
  const of = (width: number, cells: string) =>
    unpack({ width, height: 10, resolution: 0.1, origin: { x: 0, y: 0, theta: 0 }, cells });
  await of(10, whole);
  await assert.rejects(of(11, whole), /100 cells for 11 x 10/);
  await assert.rejects(of(10, whole.slice(0, 8)));
  await assert.rejects(of(10, "AAAA" + whole.slice(4)));
  await assert.rejects(of(10, "!"));
});

test("a coarser cell is a wall if any cell in it is, else free if any is", () => {
  const random = randomNumbers(2);
  for (const [width, height] of [[8, 6], [7, 5], [1, 9], [1, 1]]) {
    const fine = randomGrid(random, width, height).finest;
    const coarse = halve(fine);
    assert.deepEqual([coarse.width, coarse.height], [Math.ceil(width / 2), Math.ceil(height / 2)]);
    for (let row = 0; row < coarse.height; row++) {
      for (let column = 0; column < coarse.width; column++) {
        const inside: number[] = [];
        for (let y = 2 * row; y < Math.min(2 * row + 2, height); y++) {
          for (let x = 2 * column; x < Math.min(2 * column + 2, width); x++) inside.push(fine.cells[y * width + x]);
        }
        const expected = inside.includes(Cell.occupied) ? Cell.occupied : inside.includes(Cell.free) ? Cell.free : Cell.unknown;
        assert.equal(coarse.cells[row * coarse.width + column], expected);
      }
    }
  }
});

test("levels end at one cell, and the nearest in size is found", () => {
  const grid = randomGrid(randomNumbers(3), 100, 3, 0.05);
  assert.deepEqual([grid.level(99).width, grid.level(99).height], [1, 1]);
  assert.equal(grid.levelFor(0.05).resolution, 0.05);
  assert.equal(grid.levelFor(0.19).resolution, 0.2);
  assert.equal(grid.levelFor(0.001).resolution, 0.05);
});

test("a cell is found by its centre under any origin, and nothing beyond the edge", () => {
  const random = randomNumbers(4);
  const origin = randomPose(random);
  const grid = randomGrid(random, 9, 7, 0.25, origin);
  const at = (column: number, row: number) => grid.at(apply(origin, { x: (column + 0.5) * 0.25, y: (row + 0.5) * 0.25 }));
  for (let row = 0; row < 7; row++) {
    for (let column = 0; column < 9; column++) assert.equal(at(column, row), grid.finest.cells[row * 9 + column]);
  }
  for (const [column, row] of [[-1, 0], [0, -1], [9, 0], [0, 7]]) assert.equal(at(column, row), Cell.unknown);
});

test("a grid is not made from the wrong number of cells", () => {
  assert.throws(() => new Grid(2, 2, 1, { x: 0, y: 0, theta: 0 }, new Uint8Array(3)));
});
