// SPDX-License-Identifier: Apache-2.0
import { type Rgb, mix, parseColor, tint, white } from "./color";
import { Cell, type Grid, type Level } from "./grid";
import { type Point, type SE2, apply, compose } from "./se2";
import { type Viewport, toScreen } from "./viewport";

const mostPixels = 1600;

/** One map as a picture of its own, which can be laid anywhere at once: what tiles are too slow for. */
export class Stamp {
  readonly grid: Grid;
  private readonly level: Level;
  private readonly canvas = document.createElement("canvas");

  constructor(grid: Grid, color: string) {
    this.grid = grid;
    const { width, height } = grid.finest;
    this.level = grid.level(Math.max(0, Math.ceil(Math.log2(Math.max(width, height, 1) / mostPixels))));
    this.canvas.width = Math.max(1, this.level.width);
    this.canvas.height = Math.max(1, this.level.height);
    if (this.level.cells.length > 0) this.fill(color);
  }

  private fill(color: string): void {
    const { width, height, cells } = this.level;
    const wall = parseColor(color);
    const free = mix(white, wall, 2 * tint);
    const image = new ImageData(width, height);
    const pixels = new Uint32Array(image.data.buffer);
    const pixelOf: Record<number, number> = { [Cell.unknown]: 0, [Cell.free]: packed(free, 120), [Cell.occupied]: packed(wall, 255) };
    for (let row = 0; row < height; row++) {
      const to = (height - 1 - row) * width;
      for (let column = 0; column < width; column++) pixels[to + column] = pixelOf[cells[row * width + column]];
    }
    this.canvas.getContext("2d")!.putImageData(image, 0, 0);
  }

  draw(context: CanvasRenderingContext2D, view: Viewport, T_scene_map: SE2): void {
    const T = compose(T_scene_map, this.grid.origin);
    const { height, resolution } = this.level;
    const corner = toScreen(view, apply(T, { x: 0, y: height * resolution }));
    const cos = view.scale * resolution * Math.cos(T.theta);
    const sin = view.scale * resolution * Math.sin(T.theta);
    context.save();
    context.imageSmoothingEnabled = view.scale * resolution < 1;
    context.transform(cos, -sin, sin, cos, corner.x, corner.y);
    context.drawImage(this.canvas, 0, 0);
    context.restore();
  }
}

/** A pixel as an image holds it in memory, in the order of bytes of this machine. */
function packed([red, green, blue]: Rgb, alpha: number): number {
  return new Uint32Array(Uint8ClampedArray.of(red, green, blue, alpha).buffer)[0];
}

/** The map's rectangle on the screen, counter-clockwise from its lower left corner. */
export function outline(view: Viewport, grid: Grid, T_scene_map: SE2): Point[] {
  return grid.corners(T_scene_map).map((p) => toScreen(view, p));
}

/** Where a map in hand is turned: above the middle of its upper edge. */
export function handleOf(view: Viewport, grid: Grid, T_scene_map: SE2): { from: Point; at: Point } {
  const [, , upperRight, upperLeft] = outline(view, grid, T_scene_map);
  const from = { x: (upperRight.x + upperLeft.x) / 2, y: (upperRight.y + upperLeft.y) / 2 };
  const turn = T_scene_map.theta + grid.origin.theta;
  return { from, at: { x: from.x - 28 * Math.sin(turn), y: from.y - 28 * Math.cos(turn) } };
}

/** Whether a point lies in a convex quadrilateral. */
export function inside(quad: Point[], p: Point): boolean {
  const sides = quad.map((a, i) => {
    const b = quad[(i + 1) % quad.length];
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
  });
  return sides.every((side) => side >= 0) || sides.every((side) => side <= 0);
}
