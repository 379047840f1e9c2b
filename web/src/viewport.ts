// SPDX-License-Identifier: Apache-2.0
import { largest, smallest } from "./numbers";
import type { Point } from "./se2";

/** Pixels per metre. Nearer there is nothing more to see, and coordinates far from the origin have no finer steps. */
const mostScale = 2000;
const leastScale = 1e-6;
/** As far as zooming goes, unless the view is farther already: it shows all of a larger scene. */
const leastZoomed = 0.01;

/** A rectangle of a scene, in metres. */
export interface Box {
  left: number;
  bottom: number;
  right: number;
  top: number;
}

/** The smallest box around points; of none, a metre about the origin. */
export function boxAround(points: Point[]): Box {
  if (points.length === 0) return { left: -0.5, bottom: -0.5, right: 0.5, top: 0.5 };
  const xs = points.map(({ x }) => x);
  const ys = points.map(({ y }) => y);
  return { left: smallest(xs), bottom: smallest(ys), right: largest(xs), top: largest(ys) };
}

/** Which part of a scene a canvas of `width` by `height` pixels shows. The scene's y points up, the canvas's down. */
export interface Viewport {
  width: number;
  height: number;
  /** Point of the scene in the middle of the canvas. */
  center: Point;
  /** Pixels per metre. */
  scale: number;
}

export function toScreen(view: Viewport, p: Point): Point {
  return {
    x: view.width / 2 + (p.x - view.center.x) * view.scale,
    y: view.height / 2 - (p.y - view.center.y) * view.scale,
  };
}

export function toScene(view: Viewport, p: Point): Point {
  return {
    x: view.center.x + (p.x - view.width / 2) / view.scale,
    y: view.center.y - (p.y - view.height / 2) / view.scale,
  };
}

export function visibleBox(view: Viewport): Box {
  const halfWidth = view.width / 2 / view.scale;
  const halfHeight = view.height / 2 / view.scale;
  return {
    left: view.center.x - halfWidth,
    right: view.center.x + halfWidth,
    bottom: view.center.y - halfHeight,
    top: view.center.y + halfHeight,
  };
}

/** The view that shows the whole box with a margin; half a metre at least. */
export function fit(box: Box, width: number, height: number, margin = 0.04): Viewport {
  const room = 1 - 2 * margin;
  const least = 0.5;
  const scale = Math.min(
    (width * room) / Math.max(box.right - box.left, least), (height * room) / Math.max(box.top - box.bottom, least));
  const center = { x: (box.left + box.right) / 2, y: (box.bottom + box.top) / 2 };
  return { width, height, center, scale: Math.max(scale, leastScale) };
}

/** The view with `center` in its middle whose shorter side shows so many metres, as far as a view can. */
export function looking(center: Point, metres: number, width: number, height: number): Viewport {
  return { width, height, center, scale: Math.min(mostScale, Math.max(leastScale, Math.min(width, height) / metres)) };
}

/** Zooms by `factor` so that what is under the pixel `at` stays there. */
export function zoomed(view: Viewport, factor: number, at: Point): Viewport {
  const scale = Math.min(mostScale, Math.max(Math.min(leastZoomed, view.scale), view.scale * factor));
  const held = toScene(view, at);
  return {
    ...view,
    scale,
    center: {
      x: held.x - (at.x - view.width / 2) / scale,
      y: held.y + (at.y - view.height / 2) / scale,
    },
  };
}

/** Moves the scene by so many pixels. */
export function panned(view: Viewport, dx: number, dy: number): Viewport {
  return { ...view, center: { x: view.center.x - dx / view.scale, y: view.center.y + dy / view.scale } };
}

/** The smallest of 1, 2, 5, 10, ... (and 0.5, 0.2, ...) that is at least `least`. */
export function roundStep(least: number): number {
  const power = 10 ** Math.floor(Math.log10(least));
  for (const factor of [1, 2, 5]) if (factor * power >= least * (1 - 1e-9)) return factor * power;
  return 10 * power;
}

/** The multiples of `step` from `from` to `to`, as far as so many lines can be told apart. */
export function multiples(step: number, from: number, to: number): number[] {
  const most = 1000;
  const first = Math.ceil(from / step);
  // By count: far from zero the next number may be the same one.
  const number = Math.floor(to / step) - first + 1;
  return number > 0 ? Array.from({ length: Math.min(most, number) }, (_, i) => (first + i) * step) : [];
}
