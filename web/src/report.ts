// SPDX-License-Identifier: Apache-2.0
import type { Deformation, Shape } from "./deformation";
import type { SE2 } from "./se2";
import { probability, sayScale } from "./numbers";
import { count, flat, shortNames } from "./text";

// What a merge has to tell, as the program writes it into the page.

/** An occupancy grid: `cells` is base64 of a zlib stream of width * height bytes, row 0 at the bottom; see Cell. */
export interface PackedGrid {
  width: number;
  height: number;
  resolution: number;
  origin: SE2;
  cells: string;
  /** By which its cells are wider than the map's own, if they are. */
  coarser?: number;
}

export interface InputMap extends PackedGrid {
  name: string;
  color: string;
}

export interface Member {
  map: number;
  transform: SE2;
  probability: number | null;
  sd: { position: number; theta: number } | null;
  /** Only of bent maps. */
  deformation?: Deformation;
  /** The same without its lattice, of one of many maps: their cells come bent. */
  shape?: Shape;
}

export interface Component extends PackedGrid {
  file: string;
  /** The map whose frame the component's is; null: the plan's, or without one the world's, in which poses were given. */
  frame: number | null;
  agreeing: number;
  conflicting: number;
  members: Member[];
}

export type Outcome = "accepted" | "rescued" | "known" | "rejected" | "refused";

export const outcomes: readonly Outcome[] = ["accepted", "rescued", "known", "rejected", "refused"];

export interface Hypothesis {
  transform: SE2;
  score: number;
  probability: number;
}

export interface Join {
  fixed: number;
  moving: number;
  outcome: Outcome;
  /** Why the merge does not use it. */
  reason: string | null;
  /** What the two maps alone say; null where the data does not tell. */
  by_themselves: { verdict: "accepted" | "refused"; reason: string | null } | null;
  /** The pose that the merge uses, or the best hypothesis; the figures below are this pose's. */
  transform: SE2;
  probability: number;
  acceptance_index: number;
  agreement: number;
  disagreement: number;
  overlap: number;
  hypotheses: Hypothesis[];
}

export interface LeftOut {
  map: number;
  reason: string;
  explanation: string;
}

/** A way in which maps that lie apart may lie together: between the first maps of two groups, or maps that were left out. */
export interface OpenWay {
  fixed: number;
  moving: number;
  transform: SE2;
  probability: number;
}

/** Of many maps: the refused joins that are not in `joins`. */
export interface Refused {
  count: number;
  /** The likely ones: fixed, moving, reason, probability, x, y, theta. */
  rows: [number, number, string, number, number, number, number][];
}

/** Where the plan lies in the frame of a merged map, or of a map that was left out. */
export interface PlanPlace {
  component: number | null;
  map: number | null;
  transform: SE2;
  /** By which its own metres are enlarged there. */
  scale: number;
  probability: number;
  /** Otherwise the merge does not believe it: it is the most probable place. */
  on_plan: boolean;
}

/** An architect's plan that the merge was given. */
export interface Plan {
  name: string;
  /** By which it is too small. */
  scale: number;
  probability: number;
  /** Those that hang on it. */
  maps: number[];
  places: PlanPlace[];
  /** Its walls, in its own metres; null where its file was not at hand. */
  grid: PackedGrid | null;
}

export interface Report {
  version: string;
  /** Served by a running gridmerge, which can refine poses. */
  live: boolean;
  /** What this merge is called: a digest of all that is told of it. */
  merge: string;
  /** The number of a node's answer, whose newest one the page follows; not in other reports. */
  answer?: number;
  maps: InputMap[];
  components: Component[];
  joins: Join[];
  refused: Refused;
  left_out: LeftOut[];
  open_ways: OpenWay[];
  plan?: Plan;
}

/** Of more maps than this, lists are searched rather than read. */
const mostListed = 50;

export function isLarge(report: Report): boolean {
  return report.maps.length > mostListed;
}

/** Makes joins of the rows of refused ones, which tell no cells that the two have in common. */
export function expandRefused(report: Report): void {
  for (const [fixed, moving, reason, probability, x, y, theta] of report.refused.rows) {
    const transform = { x, y, theta };
    report.joins.push({
      fixed, moving, outcome: "refused", reason, by_themselves: null, transform, probability,
      acceptance_index: 0, agreement: 0, disagreement: 0, overlap: 0, hypotheses: [{ transform, score: 0, probability }],
    });
  }
  report.refused = { count: report.refused.count - report.refused.rows.length, rows: [] };
}

/** Whether maps hang on a plan, which is shown from the start then. */
export function isPlanBelieved(report: Report): boolean {
  return report.plan !== undefined && report.plan.maps.length > 0;
}

/** Whether the data says what the two maps have in common: of refused joins of many maps it does not. */
export function hasFigures(join: Join): boolean {
  return join.agreement + join.disagreement > 0;
}

/** Whether there is a way to lay the two maps: two that could not be compared have a placeholder instead. */
export function hasWay(join: Join): boolean {
  return isUsed(join) || join.hypotheses.length > 0 || join.probability > 0;
}

/** Whether maps lie in the result as the join says. */
export function isUsed(join: Join): boolean {
  return join.outcome !== "refused" && join.outcome !== "rejected";
}

/** What the page shows, in a word or two. */
export function heading(report: Report): string {
  if (report.components.length > 0) return "Merged maps";
  if (report.maps.length !== 1) return "Maps, none merged";
  return isPlanBelieved(report) ? "Map on a plan" : "One map";
}

/** What tells the page from others in a browser's tabs. */
export function pageTitle(report: Report): string {
  const names = shortNames(report.maps.map(({ name }) => flat(name)));
  const listed = names.length <= 3 ? names.join(", ") : `${names.slice(0, 2).join(", ")} and ${names.length - 2} more`;
  return `${heading(report)}${listed === "" ? "" : `: ${listed}`} – gridmerge`;
}

/** How the merge went: a sentence, and one of the plan if there is one. */
export function summary(report: Report): string {
  if (report.maps.length === 1 && report.plan !== undefined) return planSummary(report.plan, 1);
  const joined = report.components.reduce((sum, component) => sum + component.members.length, 0);
  const into = report.components.length === 0 ? "" : ` into ${count(report.components.length, "merged map")}`;
  const merged = `${count(report.maps.length, "map")}: ${joined} joined${into}, ${report.left_out.length} left out.`;
  return report.plan === undefined ? merged : `${merged} ${planSummary(report.plan, report.maps.length)}`;
}

function planSummary(plan: Plan, maps: number): string {
  const name = flat(plan.name);
  if (plan.maps.length === 0) return `No map hangs on the plan ${name}.`;
  const hung = `${plan.maps.length} of ${maps} hang on the plan ${name}`;
  return `${hung}, ${sayScale(plan.scale)} (probability ${probability(plan.probability)}).`;
}
