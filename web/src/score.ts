// SPDX-License-Identifier: Apache-2.0
import { Cell, type Grid, type Level } from "./grid";
import { type Point, type SE2, apply, compose, inverse } from "./se2";

/** How well a map fits to others, as the page can tell by itself: for the eye while a map is dragged. */
export interface Score {
  /** Share of the map's walls, where others have seen, that lie within a hand's breadth of a wall of theirs. */
  wallsMet: number;
  /** Share of the cells known to it and to another that are equal: agreement / (agreement + disagreement). */
  agreement: number;
  /** Share of its known cells that another knows. */
  overlap: number;
}

const mostSamples = 6000;
const reach = 0.1; // metres: the side of the cells in which walls are looked up, each with its neighbours

interface Samples {
  walls: Point[];
  known: { p: Point; cell: number }[];
}

/** Measures one map against others; takes samples of it once. */
export class Scorer {
  private readonly samples: Samples;

  constructor(grid: Grid) {
    this.samples = takeSamples(grid);
  }

  /** Poses take each map's frame to a common one. O(samples * others). Null when nothing is known in common. */
  score(pose: SE2, others: { grid: Grid; pose: SE2 }[]): Score | null {
    const lookups = others.map((other) => ({
      grid: other.grid, coarse: other.grid.levelFor(reach), T: compose(inverse(other.pose), pose),
    }));
    let agreeing = 0;
    let common = 0;
    for (const { p, cell } of this.samples.known) {
      const told = lookups.map(({ grid, T }) => grid.at(apply(T, p))).filter((other) => other !== Cell.unknown);
      if (told.length === 0) continue;
      common++;
      if (told.includes(cell as typeof told[number])) agreeing++;
    }
    if (common === 0) return null;
    let seen = 0;
    let met = 0;
    for (const p of this.samples.walls) {
      const near = lookups.map(({ grid, coarse, T }) => around(grid, coarse, apply(T, p)));
      if (near.every((cell) => cell === Cell.unknown)) continue;
      seen++;
      if (near.includes(Cell.occupied)) met++;
    }
    return {
      wallsMet: seen === 0 ? 0 : met / seen,
      agreement: agreeing / common,
      overlap: common / this.samples.known.length,
    };
  }
}

/** The strongest of what the cell and its eight neighbours say. */
function around(grid: Grid, level: Level, p: Point): number {
  let strongest: number = Cell.unknown;
  for (const dx of [-1, 0, 1]) {
    for (const dy of [-1, 0, 1]) {
      const q = { x: p.x + dx * level.resolution, y: p.y + dy * level.resolution };
      strongest = Math.max(strongest, grid.at(q, level));
    }
  }
  return strongest;
}

function takeSamples(grid: Grid): Samples {
  const { width, resolution, cells } = grid.finest;
  const all: number[] = [];
  const walls: number[] = [];
  for (let i = 0; i < cells.length; i++) {
    if (cells[i] === Cell.unknown) continue;
    all.push(i);
    if (cells[i] === Cell.occupied) walls.push(i);
  }
  const center = (i: number): Point => apply(grid.origin, {
    x: ((i % width) + 0.5) * resolution, y: (Math.floor(i / width) + 0.5) * resolution,
  });
  return {
    walls: thinned(walls).map(center),
    known: thinned(all).map((i) => ({ p: center(i), cell: cells[i] })),
  };
}

/** Spread evenly, and at most so many. */
function thinned(indices: number[]): number[] {
  const step = indices.length / Math.min(indices.length, mostSamples);
  const kept: number[] = [];
  for (let at = 0; at < indices.length; at += step) kept.push(indices[Math.floor(at)]);
  return kept;
}
