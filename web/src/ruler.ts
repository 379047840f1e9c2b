// SPDX-License-Identifier: Apache-2.0
import { degrees, fixed } from "./numbers";
import type { Point } from "./se2";

/** A length that is measured in a scene's frame. */
export interface Ruler {
  from: Point | null;
  to: Point | null;
  /** Whether the end still follows the cursor. */
  open: boolean;
}

/** Whether there is still an end to put. */
export function isUnfinished(ruler: Ruler): boolean {
  return ruler.open || ruler.to === null;
}

/** How a ruler answers to a point that is put: it begins, or ends, or begins anew. */
export function put(ruler: Ruler, point: Point): Ruler {
  return ruler.open && ruler.from ? { from: ruler.from, to: point, open: false } : { from: point, to: point, open: true };
}

/** "3.61 m", with as much of the way as there is. */
export function lengthOf({ from, to }: Ruler): string {
  return from && to ? `${fixed(Math.hypot(to.x - from.x, to.y - from.y), 2)} m` : "";
}

/** The length with its parts along the axes and its direction. */
export function describeRuler(ruler: Ruler): string {
  const { from, to } = ruler;
  if (!from || !to) return "Click where to begin, or drag.";
  const dx = to.x - from.x;
  const dy = to.y - from.y;
  return `${lengthOf(ruler)}: x ${fixed(dx, 2)} m, y ${fixed(dy, 2)} m, ${fixed(degrees(Math.atan2(dy, dx)), 1)}°`;
}
