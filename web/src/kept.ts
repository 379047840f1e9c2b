// SPDX-License-Identifier: Apache-2.0
import type { SharedView } from "./link";
import type { Report } from "./report";
import { type SceneId, firstScene, makeScene } from "./scene";
import { type Point, type SE2, apply, compose, inverse, normalizeAngle } from "./se2";

// What outlives a page goes by the names of maps: the next page may show another answer, which numbers them otherwise.

/** A scene with where it has its maps. */
export interface KeptScene {
  kind: SceneId["kind"];
  /** The map whose frame it is; null: the world's. */
  frame: string | null;
  placed: [string, SE2][];
  /** Of a join: its fixed map and its moving one. */
  pair: [string, string] | null;
}

/** As JSON holds it. */
export interface KeptView extends Omit<SharedView, "scene" | "maps" | "colors" | "placed"> {
  merge: string;
  scene: KeptScene;
  maps: [string, number][];
  /** Of those that the reader has chosen. */
  colors: [string, string][];
  hand: { scene: KeptScene; poses: [string, SE2][] }[];
}

/** By scene: poses given by hand, in its frame. */
export type HandPoses = [SceneId, Map<number, SE2>][];

/** By map: its name, and where several have it, which of them it is. */
export function keysOf({ maps }: Report): string[] {
  const seen = new Map<string, number>();
  return maps.map(({ name }) => {
    const before = seen.get(name) ?? 0;
    seen.set(name, before + 1);
    return before === 0 ? name : `${name}\n${before}`;
  });
}

function keptScene(report: Report, keys: string[], id: SceneId): KeptScene {
  const { frame, placed } = makeScene(report, id);
  const join = id.kind === "join" ? report.joins[id.join] : null;
  return {
    kind: id.kind, frame: frame === null ? null : keys[frame], placed: placed.map(({ map, T_scene_map }) => [keys[map], T_scene_map]),
    pair: join && [keys[join.fixed], keys[join.moving]],
  };
}

export function keptView(report: Report, view: SharedView, hand: HandPoses): KeptView {
  const keys = keysOf(report);
  const byKey = <T>(values: Map<number, T>): [string, T][] => [...values].map(([map, value]) => [keys[map], value]);
  const { scene, maps, colors, placed: _, ...rest } = view;
  return {
    ...rest, merge: report.merge, scene: keptScene(report, keys, scene), maps: byKey(maps),
    colors: byKey(new Map([...colors].filter(([map, color]) => color !== report.maps[map].color))),
    hand: hand.map(([id, poses]) => ({ scene: keptScene(report, keys, id), poses: byKey(poses) })),
  };
}

/** What a report shows of it. Where a scene is no more, the first one is seen, and poses that were given in it are gone. */
export function carriedOver(report: Report, kept: KeptView): { view: SharedView; hand: HandPoses } {
  const keys = keysOf(report);
  const byMap = <T>(values: [string, T][]) => new Map(values.flatMap(([key, value]): [number, T][] => {
    const map = keys.indexOf(key);
    return map < 0 ? [] : [[map, value]];
  }));
  const hand = new Map<string, Map<number, SE2>>();
  for (const { scene, poses } of kept.hand) {
    const found = findScene(report, keys, scene);
    if (!found) continue;
    const id = JSON.stringify(found.id);
    const moved = [...byMap(poses)].map(([map, pose]): [number, SE2] => [map, found.T_now_then ? compose(found.T_now_then, pose) : pose]);
    hand.set(id, new Map([...(hand.get(id) ?? []), ...moved]));
  }
  const { merge: _, hand: __, ...rest } = kept;
  const found = findScene(report, keys, kept.scene);
  const moved = (point: Point): Point => (found?.T_now_then ? apply(found.T_now_then, point) : point);
  return {
    view: {
      ...rest, scene: found?.id ?? sameScene(report, keys, kept.scene) ?? firstScene(report), maps: byMap(kept.maps), placed: new Map(),
      colors: byMap(kept.colors),
      center: found && kept.center && moved(kept.center),
      ruler: found && kept.ruler && { from: moved(kept.ruler.from), to: moved(kept.ruler.to) },
    },
    hand: [...hand].map(([id, poses]) => [JSON.parse(id) as SceneId, poses]),
  };
}

/** The scene that shows what `kept` did, and how its frame lies in that one's, if that is known; null: the frame is the same. */
function findScene(report: Report, keys: string[], kept: KeptScene): { id: SceneId; T_now_then: SE2 | null } | null {
  const id = sameScene(report, keys, kept);
  if (!id) return null;
  const { frame, placed } = makeScene(report, id);
  if ((frame === null ? null : keys[frame]) === kept.frame) return { id, T_now_then: null };
  const then = new Map(kept.placed);
  const shared = placed.find(({ map }) => then.has(keys[map]));
  return shared ? { id, T_now_then: compose(shared.T_scene_map, inverse(then.get(keys[shared.map])!)) } : null;
}

function sameScene(report: Report, keys: string[], { kind, placed, pair }: KeptScene): SceneId | null {
  const maps = placed.map(([key]) => keys.indexOf(key));
  switch (kind) {
    case "map":
      return maps[0] < 0 ? null : { kind, map: maps[0] };
    case "component": {
      // Groups grow and part: the one that has most of its maps.
      const common = report.components.map(({ members }) => members.filter(({ map }) => maps.includes(map)).length);
      const most = Math.max(0, ...common);
      return most === 0 ? null : { kind, component: common.indexOf(most) };
    }
    case "join": {
      // An answer that counts the two otherwise turns them round.
      const [one, other] = pair!.map((key) => keys.indexOf(key));
      const join = report.joins.findIndex(({ fixed, moving }) => (fixed === one && moving === other) || (fixed === other && moving === one));
      if (join < 0) return null;
      const { fixed, transform } = report.joins[join];
      const then = new Map(placed);
      const [T_one, T_other] = pair!.map((key) => then.get(key));
      const way = !T_one || !T_other ? transform : fixed === one ? compose(inverse(T_one), T_other) : compose(inverse(T_other), T_one);
      return { kind, join, hypothesis: nearestWay(report, join, way) };
    }
  }
}

/** The hypothesis that lays the two maps most like this; -1: as the merge has them. */
function nearestWay(report: Report, join: number, way: SE2): number {
  const { hypotheses, transform } = report.joins[join];
  const off = (T: SE2) => Math.hypot(T.x - way.x, T.y - way.y) + Math.abs(normalizeAngle(T.theta - way.theta));
  const offs = [...hypotheses.map((hypothesis) => hypothesis.transform), transform].map(off);
  const nearest = offs.indexOf(Math.min(...offs));
  return nearest === hypotheses.length ? -1 : nearest;
}
