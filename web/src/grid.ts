// SPDX-License-Identifier: Apache-2.0
import type { PackedGrid } from "./report";
import { type Point, type SE2, apply, compose, identity, inverse } from "./se2";

/** What a map says of a cell. */
export const Cell = { unknown: 0, free: 1, occupied: 2 } as const;

/** A level of a pyramid: each cell stands for 2^level by 2^level cells of the map. */
export interface Level {
  width: number;
  height: number;
  /** Side of a cell in metres. */
  resolution: number;
  cells: Uint8Array;
}

/** An occupancy grid in memory, and coarser drawings of it, which are made when first asked for. */
export class Grid {
  readonly origin: SE2;
  readonly levels: Level[];
  private readonly T_grid_map: SE2;

  constructor(width: number, height: number, resolution: number, origin: SE2, cells: Uint8Array) {
    if (cells.length !== width * height) throw new Error(`${cells.length} cells for ${width} x ${height}`);
    this.origin = origin;
    this.T_grid_map = inverse(origin);
    this.levels = [{ width, height, resolution, cells }];
  }

  get finest(): Level {
    return this.levels[0];
  }

  /** Level `index`, or the coarsest there is. */
  level(index: number): Level {
    while (this.levels.length <= index) {
      const last = this.levels[this.levels.length - 1];
      if (last.width <= 1 && last.height <= 1) break;
      this.levels.push(halve(last));
    }
    return this.levels[Math.min(index, this.levels.length - 1)];
  }

  /** The level whose cells are nearest to `side` metres. */
  levelFor(side: number): Level {
    return this.level(Math.max(0, Math.round(Math.log2(side / this.finest.resolution))));
  }

  /** The same cells in metres that are `factor` times as long. */
  scaled(factor: number): Grid {
    const { width, height, resolution, cells } = this.finest;
    const { x, y, theta } = this.origin;
    return new Grid(width, height, factor * resolution, { x: factor * x, y: factor * y, theta }, cells);
  }

  /** What the map says of a point of its frame. */
  at(p: Point, level: Level = this.finest): number {
    const q = apply(this.T_grid_map, p);
    const column = Math.floor(q.x / level.resolution);
    const row = Math.floor(q.y / level.resolution);
    if (column < 0 || column >= level.width || row < 0 || row >= level.height) return Cell.unknown;
    return level.cells[row * level.width + column];
  }

  /** The corners of one that may not be unpacked yet. */
  static cornersOf({ width, height, resolution, origin }: Omit<PackedGrid, "cells">, T_frame_map: SE2): Point[] {
    const T = compose(T_frame_map, origin);
    const w = width * resolution;
    const h = height * resolution;
    return [{ x: 0, y: 0 }, { x: w, y: 0 }, { x: w, y: h }, { x: 0, y: h }].map((p) => apply(T, p));
  }

  /** Its corners in the frame that `T_frame_map` takes the map's to, counter-clockwise from the lower left. */
  corners(T_frame_map: SE2 = identity): Point[] {
    return Grid.cornersOf({ ...this.finest, origin: this.origin }, T_frame_map);
  }

  /** Its middle in the map's frame. */
  middle(): Point {
    const { width, height, resolution } = this.finest;
    return apply(this.origin, { x: (width * resolution) / 2, y: (height * resolution) / 2 });
  }
}

/** Half as many cells per side: occupied if any of the four is, else free if any is, so that no wall is lost. */
export function halve(fine: Level): Level {
  const width = (fine.width + 1) >> 1;
  const height = (fine.height + 1) >> 1;
  const cells = new Uint8Array(width * height);
  for (let row = 0; row < height; row++) {
    const lower = 2 * row * fine.width;
    const upper = 2 * row + 1 < fine.height ? lower + fine.width : lower;
    for (let column = 0; column < width; column++) {
      const left = 2 * column;
      const right = left + 1 < fine.width ? left + 1 : left;
      // The codes are ordered as they win.
      cells[row * width + column] = Math.max(
        fine.cells[lower + left], fine.cells[lower + right], fine.cells[upper + left], fine.cells[upper + right]);
    }
  }
  return { width, height, resolution: 2 * fine.resolution, cells };
}

function fromBase64(text: string): Uint8Array<ArrayBuffer> {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function inflate(packed: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Throws when the cells are not what the sizes promise. */
export async function unpack(packed: PackedGrid): Promise<Grid> {
  const cells = packed.cells === "" ? new Uint8Array(0) : await inflate(fromBase64(packed.cells));
  return new Grid(packed.width, packed.height, packed.resolution, packed.origin, cells);
}
