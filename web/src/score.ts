// SPDX-License-Identifier: Apache-2.0
import { Cell, type Grid, type Level } from "./grid";
import { type Point, type SE2, apply, compose, inverse } from "./se2";

/** How well a map fits to others, as the page can tell by itself: for the eye while a map is dragged. */
export interface Score {
  /** Share of the map's walls, where others have seen, that lie within about 0.2 m of a wall of theirs, or two cells. */
  wallsMet: number;
  /** Share of the map's walls where others have seen. */
  wallsSeen: number;
  /** Share of the cells known to it and to others of which most of these say the same. */
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
      if (2 * told.filter((other) => other === cell).length >= told.length) agreeing++;
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
      wallsSeen: seen / Math.max(1, this.samples.walls.length),
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
  const center = (i: number): Point => apply(grid.origin, {
    x: ((i % width) + 0.5) * resolution, y: (Math.floor(i / width) + 0.5) * resolution,
  });
  return {
    walls: spread(cells, (cell) => cell === Cell.occupied).map(center),
    known: spread(cells, (cell) => cell !== Cell.unknown).map((i) => ({ p: center(i), cell: cells[i] })),
  };
}

/** Indices of cells of a kind, evenly taken, and at most so many. */
function spread(cells: Uint8Array, isWanted: (cell: number) => boolean): number[] {
  let count = 0;
  for (const cell of cells) if (isWanted(cell)) count++;
  const step = Math.max(1, count / mostSamples);
  const kept: number[] = [];
  let next = 0;
  for (let i = 0, seen = 0; i < cells.length; i++) {
    if (!isWanted(cells[i])) continue;
    if (seen++ < next) continue;
    kept.push(i);
    next += step;
  }
  return kept;
}
