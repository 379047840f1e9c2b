// SPDX-License-Identifier: Apache-2.0
import type { Grid } from "./grid";
import { type Report, shortNames } from "./report";
import { type Placed, type Scene, type SceneId, firstScene, makeScene, placeOf } from "./scene";
import type { Point, SE2 } from "./se2";

/** How a layer is drawn. */
export interface Look {
  visible: boolean;
  opacity: number;
}

export interface MapLook extends Look {
  color: string;
}

/** What has changed: which scene, how layers look, which map is pointed out, where the cursor is, what is placed by hand, which cells are there. */
export type Topic = "scene" | "looks" | "spotlight" | "cursor" | "hand" | "grids";

/** All that the page knows and shows. Panels and the stage change it, and listen to what others change. */
export class State {
  readonly report: Report;
  /** What maps are called on the page; exports give their full names. */
  readonly names: string[];
  /** By map; null until it is unpacked, and for good where a map's data are damaged. */
  readonly grids: (Grid | null)[];
  readonly mergedGrids: (Grid | null)[];
  readonly looks: MapLook[];
  readonly merged: Look = { visible: false, opacity: 1 };
  readonly agreement: Look = { visible: true, opacity: 1 };
  scene: Scene;
  spotlight: number | null = null;
  /** In the scene's frame. */
  cursor: Point | null = null;
  /** The map that can be dragged now. */
  handled: number | null = null;
  /** By place: poses given by hand, in the frame of that scene. */
  private readonly handPoses = new Map<string, Map<number, SE2>>();
  private readonly listeners = new Map<Topic, (() => void)[]>();

  constructor(report: Report) {
    this.report = report;
    this.names = shortNames(report.maps.map((map) => map.name));
    this.grids = report.maps.map(() => null);
    this.mergedGrids = report.components.map(() => null);
    this.looks = report.maps.map((map) => ({ visible: true, opacity: 1, color: map.color }));
    this.scene = makeScene(report, firstScene(report));
  }

  on(topic: Topic, listener: () => void): void {
    this.listeners.set(topic, [...(this.listeners.get(topic) ?? []), listener]);
  }

  changed(topic: Topic): void {
    for (const listener of this.listeners.get(topic) ?? []) listener();
  }

  show(id: SceneId): void {
    this.scene = makeScene(this.report, id);
    this.handled = null;
    this.spotlight = null;
    this.changed("scene");
  }

  /** Poses given by hand in this scene. */
  byHand(): Map<number, SE2> {
    const place = placeOf(this.scene.id);
    let poses = this.handPoses.get(place);
    if (!poses) this.handPoses.set(place, (poses = new Map()));
    return poses;
  }

  /** Where the maps of the scene lie, those that were put there by hand included. */
  placed(): Placed[] {
    const byHand = this.byHand();
    const own = this.scene.placed.map(({ map, T_scene_map }) => ({ map, T_scene_map: byHand.get(map) ?? T_scene_map }));
    const isOwn = (map: number) => this.scene.placed.some((placed) => placed.map === map);
    const added = [...byHand].filter(([map]) => !isOwn(map)).map(([map, T_scene_map]) => ({ map, T_scene_map }));
    return [...own, ...added];
  }

  poseOf(map: number): SE2 | null {
    return this.placed().find((placed) => placed.map === map)?.T_scene_map ?? null;
  }

  point(map: number | null): void {
    if (this.spotlight === map) return;
    this.spotlight = map;
    this.changed("spotlight");
  }

  /** Takes a map in hand; null lets go. */
  take(map: number | null): void {
    this.handled = map;
    this.changed("hand");
  }

  put(map: number, T_scene_map: SE2): void {
    this.byHand().set(map, T_scene_map);
    this.changed("hand");
  }

  /** Puts a map back where the merge has it, or out of the scene if it was left out. */
  putBack(map: number): void {
    this.byHand().delete(map);
    if (this.handled === map) this.handled = null;
    this.changed("hand");
  }
}
