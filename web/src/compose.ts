// SPDX-License-Identifier: Apache-2.0
import { type Rgb, disagreement, ink, mix, sepia, tint, white } from "./color";
import { Cell, type Grid } from "./grid";
import { type SE2, compose, identity, inverse } from "./se2";
import { type Box, boxAround } from "./viewport";

/** A map that lies in a scene. */
export interface Layer {
  grid: Grid;
  T_scene_map: SE2;
  color: Rgb;
  /** 0: not to be seen, 1: in full. */
  opacity: number;
  /** It lies where the merged map does not have it, and is seen above that. */
  above?: boolean;
}

/** Everything that is drawn from cells. */
export interface Picture {
  /** The fused map, in the scene's frame, over its members: at an opacity of 1 nothing is seen of them. */
  merged: { grid: Grid; opacity: number } | null;
  layers: Layer[];
  /** How strongly what the layers agree and disagree on is marked, 0 to 1. */
  agreement: number;
  /** A plan, whose walls lie over floor and under the walls of maps. */
  plan?: { grid: Grid; T_scene_map: SE2; opacity: number } | null;
}

/** The part of the scene that the picture covers. */
export function extentOf(picture: Picture): Box {
  const corners = picture.layers.flatMap((layer) => layer.grid.corners(layer.T_scene_map));
  if (picture.merged) corners.push(...picture.merged.grid.corners());
  if (picture.plan) corners.push(...picture.plan.grid.corners(picture.plan.T_scene_map));
  return boxAround(corners);
}

/** A square of `pixels` by `pixels`, each `side` metres, whose lower left corner is at (left, bottom) of the scene. */
export interface Square {
  left: number;
  bottom: number;
  side: number;
  pixels: number;
}

/** For every pixel: what the layers that were added so far say of it. */
class Votes {
  readonly walls: Uint16Array;
  readonly frees: Uint16Array;
  readonly wallOpacity: Float32Array;
  readonly freeOpacity: Float32Array;
  /** Sums of colour, weighted with opacity: red, green, blue, weight. */
  readonly wallColor: Float32Array;
  readonly freeColor: Float32Array;

  constructor(count: number) {
    this.walls = new Uint16Array(count);
    this.frees = new Uint16Array(count);
    this.wallOpacity = new Float32Array(count);
    this.freeOpacity = new Float32Array(count);
    this.wallColor = new Float32Array(4 * count);
    this.freeColor = new Float32Array(4 * count);
  }

  clear(): void {
    this.walls.fill(0);
    this.frees.fill(0);
    this.wallOpacity.fill(0);
    this.freeOpacity.fill(0);
    this.wallColor.fill(0);
    this.freeColor.fill(0);
  }
}

let scratch = new Votes(0);

function emptyVotes(count: number): Votes {
  if (scratch.walls.length === count) scratch.clear();
  else scratch = new Votes(count);
  return scratch;
}

/** Which columns and rows of the square's pixels a map may reach: from `first` to before `last`, from `above` to before `below`. */
function pixelsOf(grid: Grid, T_scene_map: SE2, { left, bottom, side, pixels }: Square): {
  first: number; last: number; above: number; below: number;
} {
  const box = boxAround(grid.corners(T_scene_map));
  const inside = (value: number) => Math.min(pixels, Math.max(0, value));
  const top = bottom + pixels * side;
  // A pixel more on each side: coarser levels of a map reach a little further.
  const margin = grid.levelFor(side).resolution / side + 1;
  return {
    first: inside(Math.floor((box.left - left) / side - margin)), last: inside(Math.ceil((box.right - left) / side + margin)),
    above: inside(Math.floor((top - box.top) / side - margin)), below: inside(Math.ceil((top - box.bottom) / side + margin)),
  };
}

/** Calls `visit(pixel, cell)` for every pixel of the square of which the map knows something. */
function sample(grid: Grid, T_scene_map: SE2, square: Square, visit: (pixel: number, cell: number) => void): void {
  const { pixels, side } = square;
  const level = grid.levelFor(side);
  const { width, height, cells, resolution } = level;
  const T_grid_scene = inverse(compose(T_scene_map, grid.origin));
  const cos = Math.cos(T_grid_scene.theta);
  const sin = Math.sin(T_grid_scene.theta);
  // Column and row of the map change by these from pixel to pixel.
  const across = (cos * side) / resolution;
  const along = (sin * side) / resolution;
  const top = square.bottom + (pixels - 0.5) * side;
  const left = square.left + 0.5 * side;
  const startColumn = (cos * left - sin * top + T_grid_scene.x) / resolution;
  const startRow = (sin * left + cos * top + T_grid_scene.y) / resolution;
  const { first, last, above, below } = pixelsOf(grid, T_scene_map, square);
  for (let j = above; j < below; j++) {
    let column = startColumn + j * along + first * across;
    let row = startRow - j * across + first * along;
    let pixel = j * pixels + first;
    for (let i = first; i < last; i++, pixel++, column += across, row += along) {
      if (column < 0 || row < 0 || column >= width || row >= height) continue;
      const cell = cells[(row | 0) * width + (column | 0)];
      if (cell !== Cell.unknown) visit(pixel, cell);
    }
  }
}

function add(votes: Votes, layer: Layer, square: Square): void {
  const [red, green, blue] = layer.color;
  const light = mix(white, layer.color, tint);
  const weight = layer.opacity;
  sample(layer.grid, layer.T_scene_map, square, (pixel, cell) => {
    const wall = cell === Cell.occupied;
    const opacity = wall ? votes.wallOpacity : votes.freeOpacity;
    const color = wall ? votes.wallColor : votes.freeColor;
    (wall ? votes.walls : votes.frees)[pixel]++;
    if (opacity[pixel] < weight) opacity[pixel] = weight;
    color[4 * pixel] += weight * (wall ? red : light[0]);
    color[4 * pixel + 1] += weight * (wall ? green : light[1]);
    color[4 * pixel + 2] += weight * (wall ? blue : light[2]);
    color[4 * pixel + 3] += weight;
  });
}

/** Lays a colour over what a pixel of `out` shows (premultiplied by nothing: plain RGBA). */
function over(out: Uint8ClampedArray, at: number, red: number, green: number, blue: number, opacity: number): void {
  const below = (out[at + 3] / 255) * (1 - opacity);
  const alpha = opacity + below;
  if (alpha <= 0) return;
  out[at] = (red * opacity + out[at] * below) / alpha;
  out[at + 1] = (green * opacity + out[at + 1] * below) / alpha;
  out[at + 2] = (blue * opacity + out[at + 2] * below) / alpha;
  out[at + 3] = 255 * alpha;
}

function layOver(out: Uint8ClampedArray, sums: Float32Array, opacities: Float32Array, pixel: number): void {
  const weight = sums[4 * pixel + 3];
  if (weight <= 0) return;
  over(out, 4 * pixel, sums[4 * pixel] / weight, sums[4 * pixel + 1] / weight, sums[4 * pixel + 2] / weight,
    opacities[pixel]);
}

/**
 * What layers agree on is black and white, what they contradict each other in has a colour of its own: in full where as
 * many say wall as floor, fainter the fewer say otherwise, since many bent maps differ a little everywhere.
 */
function mark(out: Uint8ClampedArray, walls: number, frees: number, pixel: number, opacity: number): void {
  if (walls + frees < 2) return;
  const agreed = walls >= frees ? ink : white;
  const discord = (2 * Math.min(walls, frees)) / (walls + frees);
  const color = discord === 0 ? agreed : mix(agreed, disagreement, discord);
  over(out, 4 * pixel, color[0], color[1], color[2], opacity);
}

/**
 * Draws a square of the picture as RGBA, top row first; where nothing is known it is transparent. Does not depend on
 * the order of the layers. O(pixels^2 * layers).
 */
export function paint(picture: Picture, square: Square): Uint8ClampedArray<ArrayBuffer> {
  const count = square.pixels * square.pixels;
  const out = new Uint8ClampedArray(4 * count);
  const walls = new Float32Array(count);
  if (!picture.merged || picture.merged.opacity < 1) paintLayers(picture, square, out, walls);
  if (picture.merged && picture.merged.opacity > 0) {
    cover(picture.merged, square, out, walls);
    const above = picture.layers.filter((layer) => layer.above);
    if (above.length > 0) paintLayers({ merged: null, layers: above, agreement: 0 }, square, out, walls);
  }
  if (picture.plan) paintPlan(picture.plan, walls, square, out);
  return out;
}

/** Notes in `walls` how strongly walls are drawn. */
function paintLayers(picture: Picture, square: Square, out: Uint8ClampedArray, walls: Float32Array): void {
  const count = square.pixels * square.pixels;
  const votes = emptyVotes(count);
  const visible = picture.layers.filter((layer) => layer.opacity > 0);
  for (const layer of visible) add(votes, layer, square);
  for (let pixel = 0; pixel < count; pixel++) {
    if (votes.walls[pixel] + votes.frees[pixel] === 0) continue;
    layOver(out, votes.freeColor, votes.freeOpacity, pixel);
    layOver(out, votes.wallColor, votes.wallOpacity, pixel);
    walls[pixel] = Math.max(walls[pixel], votes.wallOpacity[pixel]);
    if (picture.agreement > 0) mark(out, votes.walls[pixel], votes.frees[pixel], pixel, picture.agreement);
  }
}

/** Lays a map over what `out` shows; where it knows nothing, that fades as well. `walls` as of paintLayers(). */
function cover({ grid, opacity }: { grid: Grid; opacity: number }, square: Square, out: Uint8ClampedArray, walls: Float32Array): void {
  const known = new Uint8Array(square.pixels * square.pixels);
  sample(grid, identity, square, (pixel, cell) => {
    const [red, green, blue] = cell === Cell.occupied ? ink : white;
    over(out, 4 * pixel, red, green, blue, opacity);
    if (cell === Cell.occupied) walls[pixel] = Math.max(walls[pixel], opacity);
    known[pixel] = 1;
  });
  for (let pixel = 0; pixel < known.length; pixel++) if (known[pixel] === 0) out[4 * pixel + 3] *= 1 - opacity;
}

function paintPlan(plan: NonNullable<Picture["plan"]>, walls: Float32Array, square: Square, out: Uint8ClampedArray): void {
  const [red, green, blue] = sepia;
  sample(plan.grid, plan.T_scene_map, square, (pixel, cell) => {
    if (cell === Cell.occupied) over(out, 4 * pixel, red, green, blue, plan.opacity * (1 - walls[pixel]));
  });
}
