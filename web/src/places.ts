// SPDX-License-Identifier: Apache-2.0
import type { Report } from "./report";
import type { Placed } from "./scene";
import { type Point, type SE2, compose, inverse } from "./se2";
import { offsetOf } from "./witnesses";

/** Where a comparison has a map, in a scene. */
export interface Place {
  T_scene_map: SE2;
  /** The map of the scene that it was compared with. */
  with: number;
  probability: number;
}

/** Places that are nearer to each other are one. */
const apart = { metres: 0.5, radians: 0.1 };

/**
 * Where comparisons with maps of a scene have a map, the most probable first: every hypothesis, none twice. `middle` is the
 * map's. O(hypotheses * places).
 */
export function placesOf(report: Report, map: number, middle: Point, placed: Placed[]): Place[] {
  const all = report.joins.flatMap((join) => {
    const other = join.fixed === map ? join.moving : join.moving === map ? join.fixed : -1;
    const pose = placed.find((candidate) => candidate.map === other)?.T_scene_map;
    if (!pose) return [];
    // Of many maps the ways of a refused comparison are not listed except for one; maps that could not be compared have none.
    const ways = join.hypotheses.length > 0 ? join.hypotheses : join.probability > 0 ? [join] : [];
    return ways.map(({ transform, probability }) => ({
      T_scene_map: compose(pose, join.moving === map ? transform : inverse(transform)), with: other, probability,
    }));
  }).sort((a, b) => b.probability - a.probability);
  const places: Place[] = [];
  for (const place of all) {
    const isNew = places.every((known) => {
      const { distance, angle } = offsetOf(place.T_scene_map, known.T_scene_map, middle);
      return distance > apart.metres || angle > apart.radians;
    });
    if (isNew) places.push(place);
  }
  return places;
}
