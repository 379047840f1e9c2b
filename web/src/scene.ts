// SPDX-License-Identifier: Apache-2.0
import type { Deformation } from "./deformation";
import { type PlanPlace, type Report, hasWay } from "./report";
import { type SE2, identity } from "./se2";
import { shortNames } from "./text";

/** What can be looked at: a merged map, two maps under a hypothesis of their comparison, or a map by itself. */
export type SceneId =
  | { kind: "component"; component: number }
  | { kind: "join"; join: number; hypothesis: number }
  | { kind: "map"; map: number };

export interface Placed {
  map: number;
  T_scene_map: SE2;
  /** Only of a map that the merge has bent, where it lies as the merge has it. */
  deformation?: Deformation;
  /** Its cells are bent already: those of many maps are. */
  cameBent?: boolean;
}

export interface Scene {
  id: SceneId;
  title: string;
  /** The map whose frame coordinates are in; null: the world's, in which poses were given. */
  frame: number | null;
  placed: Placed[];
  /** Index of the component whose fused map belongs to it. */
  component: number | null;
}

/** The same for the same place, whatever is drawn of it. */
export function placeOf(id: SceneId): string {
  switch (id.kind) {
    case "component":
      return `component ${id.component}`;
    case "join":
      return `join ${id.join}`;
    case "map":
      return `map ${id.map}`;
  }
}

export function makeScene(report: Report, id: SceneId): Scene {
  const names = shortNames(report.maps.map((map) => map.name));
  switch (id.kind) {
    case "component": {
      const component = report.components[id.component];
      return {
        id,
        title: component.file,
        frame: component.frame,
        placed: component.members.map(({ map, transform, deformation, shape }) => ({
          map, T_scene_map: transform, ...(deformation && { deformation }), ...(shape && { cameBent: true }),
        })),
        component: id.component,
      };
    }
    case "join": {
      const join = report.joins[id.join];
      const transform = id.hypothesis < 0 ? join.transform : join.hypotheses[id.hypothesis].transform;
      return {
        id,
        title: `${names[join.fixed]} and ${names[join.moving]}`,
        frame: join.fixed,
        placed: hasWay(join) ? [{ map: join.fixed, T_scene_map: identity }, { map: join.moving, T_scene_map: transform }] : [],
        component: null,
      };
    }
    case "map":
      return {
        id,
        title: names[id.map],
        frame: id.map,
        placed: [{ map: id.map, T_scene_map: identity }],
        component: null,
      };
  }
}

/** Where the merge's plan lies in a scene, if it has a place there. */
export function planPlace(report: Report, id: SceneId): PlanPlace | null {
  const isThere = ({ component, map }: PlanPlace) =>
    id.kind === "component" ? component === id.component : id.kind === "map" && map === id.map;
  return report.plan?.places.find(isThere) ?? null;
}

/** What is shown first: the merged map with the lowest number, or if nothing joined, the first map. */
export function firstScene(report: Report): SceneId {
  return report.components.length > 0 ? { kind: "component", component: 0 } : { kind: "map", map: 0 };
}
