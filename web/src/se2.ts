// SPDX-License-Identifier: Apache-2.0

/** A rigid transform of the plane: turn by theta about the origin, then shift. Metres and radians. */
export interface SE2 {
  x: number;
  y: number;
  theta: number;
}

export interface Point {
  x: number;
  y: number;
}

/** Poses that lie further off are refused by gridmerge, along x or along y [m]. */
export const farthest = 1e7;

export const identity: SE2 = { x: 0, y: 0, theta: 0 };

/** The same angle in (-pi, pi]. */
export function normalizeAngle(angle: number): number {
  const turn = 2 * Math.PI;
  const rest = angle - turn * Math.floor((angle + Math.PI) / turn);
  return rest <= -Math.PI ? rest + turn : rest;
}

/** T_a_c = T_a_b * T_b_c. */
export function compose(a: SE2, b: SE2): SE2 {
  const p = apply(a, b);
  return { x: p.x, y: p.y, theta: normalizeAngle(a.theta + b.theta) };
}

/** p_a = T_a_b * p_b. */
export function apply(t: SE2, p: Point): Point {
  const cos = Math.cos(t.theta);
  const sin = Math.sin(t.theta);
  return { x: cos * p.x - sin * p.y + t.x, y: sin * p.x + cos * p.y + t.y };
}

/** T_b_a of T_a_b. */
export function inverse(t: SE2): SE2 {
  const cos = Math.cos(t.theta);
  const sin = Math.sin(t.theta);
  return { x: -cos * t.x - sin * t.y, y: sin * t.x - cos * t.y, theta: normalizeAngle(-t.theta) };
}

/** `t` shifted by (dx, dy) and turned by `turn` about `pivot`, a point of the frame that `t` takes points from. */
export function moved(t: SE2, dx: number, dy: number, turn: number, pivot: Point): SE2 {
  const before = apply(t, pivot);
  const theta = normalizeAngle(t.theta + turn);
  const after = apply({ x: 0, y: 0, theta }, pivot);
  return { x: before.x + dx - after.x, y: before.y + dy - after.y, theta };
}
