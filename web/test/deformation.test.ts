// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { drawArrows } from "../src/arrows";
import { type Deformation, bend, bentGrid, straighten } from "../src/deformation";
import { Grid } from "../src/grid";
import { apply, compose, identity, inverse } from "../src/se2";
import { State } from "../src/state";
import { randomNumbers } from "./random";
import { reportOf } from "./reports";

const random = randomNumbers(7);

function anyDeformation(): Deformation {
  const [columns, rows, spacing] = [6, 7, 1.5];
  // Neighbours differ by less than half of their distance: it cannot fold.
  const shifts = Array.from({ length: 2 * columns * rows }, () => random() * 0.36 - 0.18);
  return { kind: "elastic", frame: { x: -0.4, y: 0.7, theta: 0.3 }, spacing, columns, rows, shifts };
}

test("points are bent and straightened", () => {
  for (let i = 0; i < 200; i++) {
    const deformation = anyDeformation();
    const share = random();
    const p = { x: 12 * random() - 4, y: 12 * random() - 4 };
    const back = straighten(deformation, bend(deformation, p, share), share);
    assert.ok(Math.hypot(back.x - p.x, back.y - p.y) < 1e-4, JSON.stringify({ p, back }));
    const still = bend(deformation, p, 0);
    assert.ok(Math.hypot(still.x - p.x, still.y - p.y) < 1e-12);
  }
});

test("equal shifts are a translation in the lattice's directions", () => {
  const deformation = anyDeformation();
  deformation.shifts = deformation.shifts.map((_, i) => (i % 2 === 0 ? 0.2 : -0.1));
  const p = { x: 1, y: 2 };
  const moved = compose(compose(deformation.frame, { x: 0.2, y: -0.1, theta: 0 }), inverse(deformation.frame));
  const [q, expected] = [bend(deformation, p), apply(moved, p)];
  assert.ok(Math.hypot(q.x - expected.x, q.y - expected.y) < 1e-12);
});

test("each cell of a bent map is the one that it comes from", () => {
  const deformation = anyDeformation();
  const origin = { x: -0.5, y: 0.2, theta: -0.4 };
  // Large squares, so that what is rounded at their rims is little.
  const cells = Uint8Array.from({ length: 120 * 90 }, (_, i) => (((i % 120) >> 4) + (Math.floor(i / 120) >> 4)) % 3);
  const grid = new Grid(120, 90, 0.05, origin, cells);
  assert.equal(bentGrid(grid, deformation, 0), grid);
  for (const share of [0.3, 1]) {
    const bent = bentGrid(grid, deformation, share);
    const { width, height, resolution } = bent.finest;
    let [differ, known] = [0, 0];
    for (let row = 0; row < height; row++) {
      for (let column = 0; column < width; column++) {
        const p = apply(bent.origin, { x: (column + 0.5) * resolution, y: (row + 0.5) * resolution });
        const expected = grid.at(straighten(deformation, p, share));
        if (expected > 0) known++;
        if (bent.at(p) !== expected) differ++;
      }
    }
    assert.ok(known > 5000 && differ < 0.01 * known, `${differ} of ${known}`);
    assert.ok(known > 0.8 * cells.filter((cell) => cell > 0).length, "nothing of it is cut off");
  }
});

test("arrows are drawn of as many bent maps as a merge has", () => {
  const report = reportOf(Array(45).fill(identity), []);
  const shifts = Array.from({ length: 2 * 60 * 60 }, () => random() * 0.1 - 0.05);
  for (const member of report.components[0].members) member.deformation = { ...anyDeformation(), columns: 60, rows: 60, shifts };
  const written: string[] = [];
  const context = { save() {}, restore() {}, strokeText() {}, fillText: (text: string) => written.push(text) };
  const view = { width: 800, height: 600, center: { x: 0, y: 0 }, scale: 20 };
  drawArrows(context as unknown as CanvasRenderingContext2D, view, { line: "", text: "", halo: "" }, new State(report));
  assert.deepEqual(written, ["arrows: 50 times enlarged"]);
});
