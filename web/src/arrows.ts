// SPDX-License-Identifier: Apache-2.0
import { bend } from "./deformation";
import { Cell, type Grid } from "./grid";
import { type Placed } from "./scene";
import { type Point, apply, compose, inverse } from "./se2";
import type { State } from "./state";
import { type Viewport, roundStep, toScreen, visibleBox } from "./viewport";

const leastSpacing = 40; // pixels between arrows of a map
const leastLength = 2; // pixels: what is shorter cannot be seen to point anywhere
const head = 6; // pixels

/** Where bending moves places of the maps that are seen, or of the one that is pointed out: at true scale. */
export function drawArrows(context: CanvasRenderingContext2D, view: Viewport, state: State): void {
  const bent = state.placed().filter(({ map, deformation }) => deformation && map !== state.handled && state.looks[map].visible);
  const pointedOut = bent.filter(({ map }) => map === state.spotlight);
  context.save();
  context.lineWidth = 1.5;
  for (const placed of pointedOut.length > 0 ? pointedOut : bent) {
    const grid = state.grids[placed.map];
    if (!grid) continue;
    context.strokeStyle = context.fillStyle = state.looks[placed.map].color;
    drawArrowsOf(context, view, placed, grid);
  }
  context.restore();
}

function drawArrowsOf(context: CanvasRenderingContext2D, view: Viewport, { T_scene_map, deformation }: Placed, grid: Grid): void {
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
      drawArrow(context, toScreen(view, apply(T_scene_map, p)), toScreen(view, apply(T_scene_map, bend(deformation!, p))));
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
