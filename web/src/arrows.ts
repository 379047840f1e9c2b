// SPDX-License-Identifier: Apache-2.0
import { bend } from "./deformation";
import { type DecorColors, label } from "./decor";
import { Cell, type Grid } from "./grid";
import { largest } from "./numbers";
import { type Placed } from "./scene";
import { type Point, apply, compose, inverse } from "./se2";
import type { State } from "./state";
import { type Viewport, roundStep, toScreen, visibleBox } from "./viewport";

const leastSpacing = 40; // pixels between arrows of a map
const leastLength = 2; // pixels: what is shorter cannot be seen to point anywhere
const longest = 30; // pixels at least of the longest arrow: if it is shorter, all are enlarged
const head = 7; // pixels

/** Where bending moves places of the maps that are seen, or of the one that is pointed out; tells how much it is enlarged. */
export function drawArrows(context: CanvasRenderingContext2D, view: Viewport, colors: DecorColors, state: State): void {
  const bent = state.placed().filter(({ map, deformation }) => deformation && map !== state.handled && state.looks[map].visible);
  const pointedOut = bent.filter(({ map }) => map === state.spotlight);
  const farthest = Math.max(0, largest(bent.map(({ deformation }) => largest(deformation!.shifts.map(Math.abs)))));
  if (farthest === 0) return;
  const enlarged = Math.max(1, roundStep(longest / (farthest * view.scale)));
  context.save();
  context.lineWidth = 2;
  for (const placed of pointedOut.length > 0 ? pointedOut : bent) {
    const grid = state.grids[placed.map];
    if (!grid) continue;
    context.strokeStyle = context.fillStyle = state.looks[placed.map].color;
    drawArrowsOf(context, view, placed, grid, enlarged);
  }
  context.font = "12px system-ui, sans-serif";
  // Above the scale bar, away from what is read at the cursor.
  context.textAlign = "right";
  label(context, colors, enlarged > 1 ? `arrows: ${enlarged} times enlarged` : "arrows: true to scale", view.width - 16, view.height - 44);
  context.restore();
}

function drawArrowsOf(
  context: CanvasRenderingContext2D, view: Viewport, { T_scene_map, deformation }: Placed, grid: Grid, enlarged: number,
): void {
  const box = visibleBox(view);
  const step = roundStep(leastSpacing / view.scale);
  const T_scene_grid = compose(T_scene_map, grid.origin);
  const { width, height, resolution } = grid.finest;
  // Only what is in sight, in the grid's own directions.
  const seen = [{ x: box.left, y: box.bottom }, { x: box.right, y: box.bottom }, { x: box.right, y: box.top }, { x: box.left, y: box.top }]
    .map((corner) => apply(inverse(T_scene_grid), corner));
  const range = (values: number[], most: number) => [Math.max(0, Math.min(...values)), Math.min(most, Math.max(...values))];
  const [left, right] = range(seen.map(({ x }) => x), width * resolution);
  const [bottom, top] = range(seen.map(({ y }) => y), height * resolution);
  for (let j = Math.ceil(bottom / step - 0.5); (j + 0.5) * step < top; j++) {
    for (let i = Math.ceil(left / step - 0.5); (i + 0.5) * step < right; i++) {
      const p = apply(grid.origin, { x: (i + 0.5) * step, y: (j + 0.5) * step });
      if (grid.at(p) === Cell.unknown) continue;
      const from = toScreen(view, apply(T_scene_map, p));
      const to = toScreen(view, apply(T_scene_map, bend(deformation!, p)));
      drawArrow(context, from, { x: from.x + enlarged * (to.x - from.x), y: from.y + enlarged * (to.y - from.y) });
    }
  }
}

function drawArrow(context: CanvasRenderingContext2D, from: Point, to: Point): void {
  const length = Math.hypot(to.x - from.x, to.y - from.y);
  if (length < leastLength) return;
  const along = { x: (to.x - from.x) / length, y: (to.y - from.y) / length };
  const side = Math.min(head, 0.6 * length);
  context.beginPath();
  context.moveTo(from.x, from.y);
  context.lineTo(to.x, to.y);
  context.stroke();
  context.beginPath();
  context.moveTo(to.x, to.y);
  context.lineTo(to.x - side * (along.x - 0.5 * along.y), to.y - side * (along.y + 0.5 * along.x));
  context.lineTo(to.x - side * (along.x + 0.5 * along.y), to.y - side * (along.y - 0.5 * along.x));
  context.fill();
}
