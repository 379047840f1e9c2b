// SPDX-License-Identifier: Apache-2.0
import { Cell, Grid } from "./grid";
import { type Point, type SE2, apply, compose, inverse } from "./se2";

/** What is done to a map. */
export interface Shape {
  kind: "similarity" | "affine" | "elastic";
  /** Of a similarity, and the mean one of an affine map. */
  scale?: number;
}

/** How a map is bent, as transforms.json has it: see docs/merging.md. */
export interface Deformation extends Shape {
  /** Of the lattice in the map's frame. */
  frame: SE2;
  /** Between neighbouring points, in metres. */
  spacing: number;
  columns: number;
  rows: number;
  /** x and y of each point's, in metres, in the lattice's directions, row by row. */
  shifts: number[];
}

/** The source of a bent cell is worked out for one in so many, along rows and columns; between these it is nearly linear. */
const cellsBetween = 8;
const mostSteps = 40;

function basis(t: number): [number, number, number, number] {
  const s = 1 - t;
  return [s ** 3 / 6, (3 * t ** 3 - 6 * t ** 2 + 4) / 6, (-3 * t ** 3 + 3 * t ** 2 + 3 * t + 1) / 6, t ** 3 / 6];
}

/** The shift at a point of the lattice's frame, in its directions. */
function shiftAt({ spacing, columns, rows, shifts }: Deformation, q: Point): Point {
  const x = Math.min(Math.max(q.x / spacing, 0), columns - 3);
  const y = Math.min(Math.max(q.y / spacing, 0), rows - 3);
  const column = Math.min(Math.floor(x), columns - 4);
  const row = Math.min(Math.floor(y), rows - 4);
  const ofX = basis(x - column);
  const ofY = basis(y - row);
  const sum = { x: 0, y: 0 };
  for (let b = 0; b < 4; b++) {
    for (let a = 0; a < 4; a++) {
      const weight = ofX[a] * ofY[b];
      const i = 2 * ((row + b) * columns + column + a);
      sum.x += weight * shifts[i];
      sum.y += weight * shifts[i + 1];
    }
  }
  return sum;
}

/** Where a point goes, in the map's frame, when the map is bent by this share: 0 not at all, 1 as it was merged. */
export function bend(deformation: Deformation, p: Point, share = 1): Point {
  const q = apply(inverse(deformation.frame), p);
  const shift = shiftAt(deformation, q);
  return apply(deformation.frame, { x: q.x + share * shift.x, y: q.y + share * shift.y });
}

/** Where a point comes from; each step halves the error at least. */
function straightenInLattice(deformation: Deformation, target: Point, share: number): Point {
  let q = target;
  for (let step = 0; step < mostSteps; step++) {
    const shift = shiftAt(deformation, q);
    const next = { x: target.x - share * shift.x, y: target.y - share * shift.y };
    const change = Math.abs(next.x - q.x) + Math.abs(next.y - q.y);
    q = next;
    if (change < 1e-5 * deformation.spacing) break;
  }
  return q;
}

export function straighten(deformation: Deformation, p: Point, share = 1): Point {
  return apply(deformation.frame, straightenInLattice(deformation, apply(inverse(deformation.frame), p), share));
}

/** The map as it looks when it is bent, with cells of the same size in the same frame. */
export function bentGrid(grid: Grid, deformation: Deformation, share: number): Grid {
  const { width, height, resolution, cells } = grid.finest;
  if (share === 0 || width === 0 || height === 0) return grid;
  const farthest = deformation.shifts.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
  const margin = Math.ceil((share * Math.SQRT2 * farthest) / resolution) + 1;
  const wide = width + 2 * margin;
  const high = height + 2 * margin;
  const T_lattice_grid = compose(inverse(deformation.frame), grid.origin);
  const T_grid_lattice = inverse(T_lattice_grid);
  // Where nodes come from [cells of the grid].
  const nodes = Math.ceil(wide / cellsBetween) + 1;
  const lines = Math.ceil(high / cellsBetween) + 1;
  const fromX = new Float64Array(nodes * lines);
  const fromY = new Float64Array(nodes * lines);
  for (let line = 0; line < lines; line++) {
    for (let node = 0; node < nodes; node++) {
      const at = { x: (node * cellsBetween + 0.5 - margin) * resolution, y: (line * cellsBetween + 0.5 - margin) * resolution };
      const p = apply(T_grid_lattice, straightenInLattice(deformation, apply(T_lattice_grid, at), share));
      fromX[line * nodes + node] = p.x / resolution;
      fromY[line * nodes + node] = p.y / resolution;
    }
  }
  const bent = new Uint8Array(wide * high).fill(Cell.unknown);
  for (let row = 0; row < high; row++) {
    const line = Math.floor(row / cellsBetween);
    const v = row / cellsBetween - line;
    for (let node = 0; node + 1 < nodes; node++) {
      const lower = line * nodes + node;
      const upper = lower + nodes;
      let x = (1 - v) * fromX[lower] + v * fromX[upper];
      let y = (1 - v) * fromY[lower] + v * fromY[upper];
      const dx = ((1 - v) * fromX[lower + 1] + v * fromX[upper + 1] - x) / cellsBetween;
      const dy = ((1 - v) * fromY[lower + 1] + v * fromY[upper + 1] - y) / cellsBetween;
      const last = Math.min(wide, (node + 1) * cellsBetween);
      for (let column = node * cellsBetween; column < last; column++, x += dx, y += dy) {
        if (x >= 0 && x < width && y >= 0 && y < height) {
          bent[row * wide + column] = cells[Math.floor(y) * width + Math.floor(x)];
        }
      }
    }
  }
  const origin = compose(grid.origin, { x: -margin * resolution, y: -margin * resolution, theta: 0 });
  return new Grid(wide, high, resolution, origin, bent);
}
