// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { Cell, Grid } from "../src/grid";
import { fromHash, defaultView } from "../src/link";
import type { Plan, Report } from "../src/report";
import { planPlace } from "../src/scene";
import { identity } from "../src/se2";
import { State } from "../src/state";
import { reportOf } from "./reports";

const packed = { width: 2, height: 1, resolution: 0.1, origin: { x: 1, y: 2, theta: 0 }, cells: "" };
const away = { x: 4, y: 5, theta: 1 };

function withPlan(plan: Partial<Plan> = {}): Report {
  const places = [
    { component: 0, map: null, transform: identity, scale: 1.25, probability: 0.97, on_plan: true },
    { component: null, map: 2, transform: away, scale: 0.5, probability: 0.2, on_plan: false },
  ];
  return {
    ...reportOf([identity, identity, identity]),
    plan: { name: "floor.png", scale: 1.25, probability: 0.97, maps: [0, 1], places, grid: packed, ...plan },
  };
}

test("a plan has a place in the scenes that it was laid under", () => {
  const report = withPlan();
  assert.equal(planPlace(report, { kind: "component", component: 0 })?.scale, 1.25);
  assert.equal(planPlace(report, { kind: "map", map: 2 })?.on_plan, false);
  assert.equal(planPlace(report, { kind: "map", map: 0 }), null);
  assert.equal(planPlace(report, { kind: "join", join: 0, hypothesis: 0 }), null);
  assert.equal(planPlace(reportOf([identity]), { kind: "component", component: 0 }), null);
});

test("it is drawn in metres of the maps, at the scale of each scene", () => {
  const state = new State(withPlan());
  assert.equal(state.placedPlan(), null, "not before it is unpacked");
  state.planGrid = new Grid(2, 1, 0.1, { x: 1, y: 2, theta: 0 }, Uint8Array.of(Cell.occupied, Cell.unknown));
  const hung = state.placedPlan()!;
  assert.deepEqual(hung.grid.corners()[0], { x: 1.25, y: 2.5 });
  assert.equal(hung.grid.finest.resolution, 0.125);
  state.show({ kind: "map", map: 2 });
  const guessed = state.placedPlan()!;
  assert.deepEqual(guessed.T_scene_map, away);
  assert.equal(guessed.grid.finest.resolution, 0.05);
  state.show({ kind: "map", map: 0 });
  assert.equal(state.placedPlan(), null);
});

test("it is shown from the start if a map hangs on it, and not where its file was gone", () => {
  assert.ok(new State(withPlan()).plan.visible);
  assert.ok(!new State(withPlan({ maps: [] })).plan.visible);
  const state = new State(withPlan({ grid: null }));
  assert.equal(state.planPlace(), null);
  assert.equal(defaultView(withPlan()).plan, 1);
  assert.equal(fromHash("#plan=0.25", withPlan(), []).plan, 0.25);
  assert.equal(fromHash("#plan=7", withPlan({ maps: [] }), []).plan, 0);
});
