// SPDX-License-Identifier: Apache-2.0
import { bentGrid } from "./deformation";
import type { Grid } from "./grid";
import type { HandPoses } from "./kept";
import { type PlanPlace, type Report, isPlanBelieved } from "./report";
import type { Ruler } from "./ruler";
import { type Placed, type Scene, type SceneId, firstScene, makeScene, planPlace } from "./scene";
import type { Point, SE2 } from "./se2";
import { shortNames } from "./text";

/** How a layer is drawn. */
export interface Look {
  visible: boolean;
  opacity: number;
}

export interface MapLook extends Look {
  color: string;
}

/**
 * What has changed: which scene, how layers look, in which colours, which map is pointed out, where the cursor is, what is
 * measured, whether there is a metre grid, what is placed by hand, which cells are there, which maps are searched for, how far maps are bent.
 */
export type Topic = "scene" | "looks" | "colors" | "spotlight" | "cursor" | "ruler" | "metres" | "hand" | "grids" | "query" | "bend";

/** The map in hand, whose cells are there. */
export interface InHand {
  map: number;
  grid: Grid;
  pose: SE2;
}

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
  /** In its own metres; null until it is unpacked, and for good where there is none. */
  planGrid: Grid | null = null;
  readonly plan: Look;
  /** By which share bent maps are bent: 0 shows them as they were read, 1 as they are merged. */
  bent = 1;
  /** Whether arrows show where bending moves them. */
  arrows = false;
  scene: Scene;
  spotlight: number | null = null;
  /** The map that is pointed out while nothing else is: it was chosen from a list. */
  private chosen: number | null = null;
  /** In the scene's frame. */
  cursor: Point | null = null;
  /** Null while nothing is to be measured. */
  ruler: Ruler | null = null;
  /** What is searched for in the names of maps. */
  query = "";
  /** Maps that somebody asked for, whose cells are to be there before others'. */
  wanted: number[] = [];
  /** The map that can be dragged now. */
  handled: number | null = null;
  /** The scene that was shown last and is no join. */
  whole: SceneId;
  /** Where the map in hand is shown as long as nobody has moved it, if it is not of the scene. */
  private offered: SE2 | null = null;
  /** By scene: poses given by hand, in its frame. */
  private readonly handPoses = new Map<string, Map<number, SE2>>();
  private scaledPlan: { scale: number; grid: Grid } | null = null;
  private readonly bentGrids = new Map<number, { of: Grid; share: number; grid: Grid }>();
  private readonly listeners = new Map<Topic, (() => void)[]>();

  constructor(report: Report) {
    this.report = report;
    this.names = shortNames(report.maps.map((map) => map.name));
    this.grids = report.maps.map(() => null);
    this.mergedGrids = report.components.map(() => null);
    this.looks = report.maps.map((map) => ({ visible: true, opacity: 1, color: map.color }));
    this.plan = { visible: isPlanBelieved(report), opacity: 1 };
    this.whole = firstScene(report);
    this.scene = makeScene(report, this.whole);
  }

  on(topic: Topic, listener: () => void): void {
    this.listeners.set(topic, [...(this.listeners.get(topic) ?? []), listener]);
  }

  changed(topic: Topic): void {
    for (const listener of this.listeners.get(topic) ?? []) listener();
  }

  show(id: SceneId): void {
    this.scene = makeScene(this.report, id);
    if (id.kind !== "component") this.wanted = this.scene.placed.map(({ map }) => map);
    if (id.kind !== "join") this.whole = id;
    this.handled = this.offered = null;
    this.spotlight = this.chosen = null;
    // Another frame: what was measured in the old one means nothing.
    if (this.ruler) this.measure({ from: null, to: null, open: false });
    this.changed("scene");
  }

  /** Poses given by hand in this scene. */
  byHand(): Map<number, SE2> {
    const scene = JSON.stringify(this.scene.id);
    let poses = this.handPoses.get(scene);
    if (!poses) this.handPoses.set(scene, (poses = new Map()));
    return poses;
  }

  /** Poses given by hand in all scenes. */
  allByHand(): HandPoses {
    return [...this.handPoses].filter(([, poses]) => poses.size > 0).map(([id, poses]) => [JSON.parse(id) as SceneId, poses]);
  }

  layByHand(hand: HandPoses): void {
    for (const [id, poses] of hand) this.handPoses.set(JSON.stringify(id), new Map(poses));
    this.changed("hand");
  }

  /** Where the maps of the scene lie, one that is only offered included. */
  placed(): Placed[] {
    const offered = this.offered ? [{ map: this.handled!, T_scene_map: this.offered }] : [];
    return [...this.settled(), ...offered];
  }

  /** The same without the one that is offered: where the merge or somebody has put them. */
  settled(): Placed[] {
    const byHand = this.byHand();
    const own = this.scene.placed.map((placed) => {
      const T_scene_map = byHand.get(placed.map);
      return T_scene_map ? { map: placed.map, T_scene_map } : placed;
    });
    const isOwn = (map: number) => this.scene.placed.some((placed) => placed.map === map);
    const added: Placed[] = [...byHand].filter(([map]) => !isOwn(map)).map(([map, T_scene_map]) => ({ map, T_scene_map }));
    return [...own, ...added];
  }

  poseOf(map: number): SE2 | null {
    return this.placed().find((placed) => placed.map === map)?.T_scene_map ?? null;
  }

  /** Whether the scene has maps that the merge has bent. */
  hasBent(): boolean {
    return this.scene.placed.some(({ deformation }) => deformation !== undefined);
  }

  /** Where the plan lies in the scene, if there is one to be drawn. */
  planPlace(): PlanPlace | null {
    return this.report.plan?.grid ? planPlace(this.report, this.scene.id) : null;
  }

  /** The plan as it lies in the scene, whether it is shown or not; null until it is there. */
  placedPlan(): { grid: Grid; T_scene_map: SE2 } | null {
    const place = this.planPlace();
    if (!place || !this.planGrid || this.planGrid.finest.width === 0) return null;
    if (this.scaledPlan?.scale !== place.scale) {
      this.scaledPlan = { scale: place.scale, grid: this.planGrid.scaled(place.scale) };
    }
    return { grid: this.scaledPlan.grid, T_scene_map: place.transform };
  }

  setBent(share: number): void {
    if (share === this.bent) return;
    this.bent = share;
    this.changed("bend");
  }

  showArrows(shown: boolean): void {
    this.arrows = shown;
    this.changed("bend");
  }

  /** A placed map's cells as they are drawn: bent as far as it is shown, and straight in hand; null until they are there. */
  gridOf(placed: Placed): Grid | null {
    return placed.map === this.handled ? this.grids[placed.map] : this.bentGridOf(placed);
  }

  /** The same whether the map is in hand or not. */
  bentGridOf({ map, deformation }: Placed): Grid | null {
    const grid = this.grids[map];
    if (!grid || !deformation || this.bent === 0) return grid;
    const known = this.bentGrids.get(map);
    if (known && known.of === grid && known.share === this.bent) return known.grid;
    const bent = bentGrid(grid, deformation, this.bent);
    this.bentGrids.set(map, { of: grid, share: this.bent, grid: bent });
    return bent;
  }

  inHand(): InHand | null {
    const map = this.handled;
    const grid = map === null ? null : this.grids[map];
    const pose = map === null ? null : this.poseOf(map);
    return map !== null && grid && pose ? { map, grid, pose } : null;
  }

  search(query: string): void {
    if (query === this.query) return;
    this.query = query;
    this.changed("query");
  }

  /** Whether a map's name, or its number, is what is searched for. */
  isFound(map: number): boolean {
    const query = this.query.trim().toLowerCase();
    // Folders that all maps lie in would find all of them, unless they are asked for with what is in them.
    const name = query.includes("/") ? this.report.maps[map].name : this.names[map];
    return query === "" || query === String(map + 1) || name.toLowerCase().includes(query);
  }

  measure(ruler: Ruler | null): void {
    this.ruler = ruler;
    this.changed("ruler");
  }

  point(map: number | null): void {
    const pointed = map ?? this.chosen;
    if (this.spotlight === pointed) return;
    this.spotlight = pointed;
    this.changed("spotlight");
  }

  /** Points a map out until something else is chosen or taken in hand. */
  choose(map: number | null): void {
    this.chosen = map;
    this.point(map);
  }

  /** Takes a map in hand; one that is not in the scene is offered at `T_scene_map`, and gone again if nobody moves it. */
  take(map: number, T_scene_map: SE2): void {
    this.choose(null);
    this.offered = null;
    this.offered = this.poseOf(map) ? null : T_scene_map;
    this.handled = map;
    this.changed("hand");
  }

  letGo(): void {
    this.handled = this.offered = null;
    this.changed("hand");
  }

  put(map: number, T_scene_map: SE2): void {
    if (map === this.handled) this.offered = null;
    this.byHand().set(map, T_scene_map);
    this.changed("hand");
  }

  /** Puts a map back where the merge has it, or out of the scene if it was left out. */
  putBack(map: number): void {
    this.byHand().delete(map);
    if (this.handled === map) this.handled = this.offered = null;
    this.changed("hand");
  }
}
