// SPDX-License-Identifier: Apache-2.0
import { type Report, isLarge, isPlanBelieved } from "./report";
import { type SceneId, firstScene } from "./scene";
import { type Point, type SE2, farthest, normalizeAngle } from "./se2";

/** All that a link to a view restores. */
export interface SharedView {
  scene: SceneId;
  /** The point of the scene in the middle, and how many metres the view's shorter side shows; null: all of the scene. */
  center: Point | null;
  metres: number;
  tab: string;
  /** How strongly these are drawn; 0 for what is hidden. */
  merged: number;
  agreement: number;
  plan: number;
  /** By map; those that are not named are seen in full. */
  maps: Map<number, number>;
  /** By map, "#rrggbb"; those that are not named have the report's. */
  colors: Map<number, string>;
  /** By map: poses given by hand in this scene. */
  placed: Map<number, SE2>;
  grid: boolean;
  /** By which share bent maps are bent. */
  bent: number;
  arrows: boolean;
  ruler: { from: Point; to: Point } | null;
}

/** What a report shows when it is opened. */
export function defaultView(report: Report): SharedView {
  return {
    scene: firstScene(report), center: null, metres: 0, tab: isLarge(report) ? "overview" : "layers",
    // A thousand maps over each other say less than what they make.
    merged: isLarge(report) && report.components.length > 0 ? 1 : 0, agreement: 1, plan: isPlanBelieved(report) ? 1 : 0, maps: new Map(), colors: new Map(),
    placed: new Map(), grid: true, bent: 1, arrows: false, ruler: null,
  };
}

/** What numbers maps and scenes, or lies in the frame of one, and says nothing of another merge. */
const ownParts = ["show", "at", "maps", "colors", "placed", "ruler"];

/** As the part of an address behind its "#": only what differs from the default, so that links stay short. */
export function toHash(view: SharedView, report: Report): string {
  const usual = defaultView(report);
  const parts = new Map<string, string>();
  const { scene } = view;
  const name = scene.kind === "join" ? `join-${scene.join}-${scene.hypothesis}` : scene.kind === "map" ? `map-${scene.map}` : `merged-${scene.component}`;
  if (JSON.stringify(scene) !== JSON.stringify(usual.scene)) parts.set("show", name);
  if (view.center) parts.set("at", [view.center.x, view.center.y, view.metres].map((value) => short(value)).join(","));
  if (view.tab !== usual.tab) parts.set("tab", view.tab);
  if (view.merged !== usual.merged) parts.set("merged", short(view.merged));
  if (view.agreement !== usual.agreement) parts.set("agreement", short(view.agreement));
  if (view.plan !== usual.plan) parts.set("plan", short(view.plan));
  const faded = [...view.maps].filter(([, opacity]) => opacity !== 1);
  if (faded.length > 0) parts.set("maps", faded.map(([map, opacity]) => `${map}:${short(opacity)}`).join(","));
  const colored = [...view.colors].filter(([map, color]) => color !== report.maps[map].color);
  if (colored.length > 0) parts.set("colors", colored.map(([map, color]) => `${map}:${color.slice(1)}`).join(","));
  // A pose is no matter of pixels: far from the origin the least turn moves its map.
  const placed = [...view.placed].map(([map, { x, y, theta }]) => `${map}:${[x, y, theta].map((value) => String(value + 0)).join(",")}`);
  if (placed.length > 0) parts.set("placed", placed.join(";"));
  if (!view.grid) parts.set("grid", "0");
  if (view.bent !== usual.bent) parts.set("bent", short(view.bent));
  if (view.arrows) parts.set("arrows", "1");
  if (view.ruler) {
    const { from, to } = view.ruler;
    parts.set("ruler", [from.x, from.y, to.x, to.y].map((value) => short(value)).join(","));
  }
  if (ownParts.some((key) => parts.has(key))) parts.set("of", report.merge);
  return [...parts].map(([key, value]) => `${key}=${value}`).join("&");
}

/** Whether a hash is of another merge than the report's. Links of before do not say of which they are. */
export function isForeign(hash: string, report: Report): boolean {
  return ![undefined, report.merge].includes(partsOf(hash).get("of"));
}

function partsOf(hash: string): Map<string, string> {
  return new Map(hash.replace(/^#/, "").split("&").map((part) => {
    const at = part.indexOf("=");
    return [part.slice(0, at), part.slice(at + 1)] as const;
  }));
}

/** Reads a hash, with its "#" or without. What is damaged, or of another merge, is as in the default. */
export function fromHash(hash: string, report: Report, tabs: readonly string[]): SharedView {
  const view = defaultView(report);
  const parts = partsOf(hash);
  if (isForeign(hash, report)) for (const key of ownParts) parts.delete(key);
  const get = (key: string) => parts.get(key) ?? "";
  view.scene = sceneOf(get("show"), report) ?? view.scene;
  const at = numbers(get("at"), 3);
  if (at && at[2] > 0) {
    view.center = { x: at[0], y: at[1] };
    view.metres = at[2];
  }
  if (tabs.includes(get("tab"))) view.tab = get("tab");
  view.merged = share(get("merged")) ?? view.merged;
  view.agreement = share(get("agreement")) ?? view.agreement;
  view.plan = share(get("plan")) ?? view.plan;
  for (const part of get("maps").split(",")) {
    const [, map, opacity] = /^(\d+):(.*)$/.exec(part) ?? [];
    const faded = share(opacity ?? "");
    if (faded !== null && Number(map) < report.maps.length) view.maps.set(Number(map), faded);
  }
  for (const part of get("colors").split(",")) {
    const [, map, color] = /^(\d+):([0-9a-f]{6})$/.exec(part) ?? [];
    if (color && Number(map) < report.maps.length) view.colors.set(Number(map), `#${color}`);
  }
  for (const part of get("placed").split(";")) {
    const [, map, pose] = /^(\d+):(.*)$/.exec(part) ?? [];
    const values = numbers(pose ?? "", 3);
    if (values && Number(map) < report.maps.length && Math.max(Math.abs(values[0]), Math.abs(values[1])) <= farthest) {
      view.placed.set(Number(map), { x: values[0], y: values[1], theta: normalizeAngle(values[2]) });
    }
  }
  view.grid = get("grid") !== "0";
  view.bent = share(get("bent")) ?? view.bent;
  view.arrows = get("arrows") === "1";
  const ends = numbers(get("ruler"), 4);
  if (ends) view.ruler = { from: { x: ends[0], y: ends[1] }, to: { x: ends[2], y: ends[3] } };
  return view;
}

function sceneOf(text: string, report: Report): SceneId | null {
  const [, kind, first, second] = /^(merged|map|join)-(\d+)(?:-(-?\d+))?$/.exec(text) ?? [];
  const index = Number(first);
  if (kind === "merged" && index < report.components.length) return { kind: "component", component: index };
  if (kind === "map" && index < report.maps.length) return { kind: "map", map: index };
  const hypothesis = Number(second);
  if (kind === "join" && index < report.joins.length && hypothesis >= -1 && hypothesis < report.joins[index].hypotheses.length) {
    return { kind: "join", join: index, hypothesis };
  }
  return null;
}

/** Finer than any pixel, so that a view comes back as it was. */
function short(value: number): string {
  return String(Number(value.toFixed(5)) + 0);
}

function numbers(text: string, count: number): number[] | null {
  const values = text.split(",").map((part) => (/^-?\d+(\.\d+)?(e-\d+)?$/.test(part) ? Number(part) : NaN));
  return values.length === count && values.every((value) => Math.abs(value) <= 1e9) ? values : null;
}

function share(text: string): number | null {
  const [value] = numbers(text, 1) ?? [NaN];
  return value >= 0 && value <= 1 ? value : null;
}
