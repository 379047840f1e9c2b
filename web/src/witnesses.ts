// SPDX-License-Identifier: Apache-2.0
import { type Join, type Report, isUsed } from "./report";
import { type Point, type SE2, apply, compose, inverse, normalizeAngle } from "./se2";

/** How far two poses of a map lie apart. */
export interface Offset {
  /** Between where the two put a point of the map [m]. */
  distance: number;
  /** Between the directions [rad], not negative. */
  angle: number;
}

/** A third map that is joined to both maps of a join, and how far its two joins put the moving map from the join's pose. */
export interface Witness {
  map: number;
  offset: Offset;
}

export function offsetOf(a: SE2, b: SE2, point: Point): Offset {
  const p = apply(a, point);
  const q = apply(b, point);
  return { distance: Math.hypot(p.x - q.x, p.y - q.y), angle: Math.abs(normalizeAngle(a.theta - b.theta)) };
}

/**
 * What other maps say of a join, nearest first: T_fixed_moving over each map to which the merge joins both. `point` is of
 * the moving map, such as its middle. O(joins).
 */
export function witnessesOf(report: Report, join: Join, point: Point): Witness[] {
  const toOthers = (map: number) => {
    const poses = new Map<number, SE2>();
    for (const other of report.joins) {
      if (!isUsed(other) || other === join) continue;
      if (other.fixed === map) poses.set(other.moving, other.transform);
      else if (other.moving === map) poses.set(other.fixed, inverse(other.transform));
    }
    return poses;
  };
  const T_moving_other = toOthers(join.moving);
  return [...toOthers(join.fixed)].flatMap(([map, T_fixed_other]) => {
    const T = T_moving_other.get(map);
    return T ? [{ map, offset: offsetOf(compose(T_fixed_other, inverse(T)), join.transform, point) }] : [];
  }).sort((a, b) => a.offset.distance - b.offset.distance);
}

/** T_fixed_moving as the merged map has the two; null if they are not in the same one. */
export function mergedPose(report: Report, join: Join): SE2 | null {
  for (const { members } of report.components) {
    const fixed = members.find(({ map }) => map === join.fixed);
    const moving = members.find(({ map }) => map === join.moving);
    if (fixed && moving) return compose(inverse(fixed.transform), moving.transform);
  }
  return null;
}
