// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { probability, sayDeviation } from "../src/numbers";
import { type Report, expandRefused, hasFigures, isLarge, pageTitle, summary } from "../src/report";
import { identity } from "../src/se2";
import { State } from "../src/state";
import { flat, shortNames } from "../src/text";
import { reportOf } from "./reports";

test("short names drop only folders that all maps share", () => {
  assert.deepEqual(shortNames(["m/a/1.yaml", "m/a/2.yaml"]), ["1.yaml", "2.yaml"]);
  assert.deepEqual(shortNames(["m/a/map.yaml", "m/b/map.yaml"]), ["a/map.yaml", "b/map.yaml"]);
  assert.deepEqual(shortNames(["m/ab/1", "m/a/1"]), ["ab/1", "a/1"]);
  assert.deepEqual(shortNames(["/x/1", "y/1", "1"]), ["/x/1", "y/1", "1"]);
  assert.deepEqual(shortNames(["/x/1", "/y/2"]), ["/x/1", "/y/2"], "the root is no folder to be dropped");
  assert.deepEqual(shortNames(["only.yaml"]), ["only.yaml"]);
  assert.deepEqual(shortNames([]), []);
});

test("the summary counts", () => {
  const report = (joined: number[], leftOut: number, maps: number) => ({
    maps: Array(maps).fill(null), components: joined.map((n) => ({ members: Array(n).fill(null) })), left_out: Array(leftOut).fill(null),
  }) as unknown as Report;
  assert.equal(summary(report([3], 1, 4)), "4 maps: 3 joined into 1 merged map, 1 left out.");
  assert.equal(summary(report([3, 2], 0, 5)), "5 maps: 5 joined into 2 merged maps, 0 left out.");
  assert.equal(summary(report([], 2, 2)), "2 maps: 0 joined, 2 left out.");
});

test("the summary tells of a plan", () => {
  const report = { ...reportOf([identity, identity]), plan: { name: "floor.png", scale: 1.25, probability: 0.9996, maps: [0], places: [], grid: null } };
  assert.match(summary(report), /left out\. 1 of 2 hang on the plan floor\.png, enlarged by 1\.2500 \(probability > 0\.999\)\.$/);
  assert.match(summary({ ...report, plan: { ...report.plan, maps: [] } }), /left out\. No map hangs on the plan floor\.png\.$/);
  const alone = { ...reportOf([identity]), components: [], plan: { ...report.plan, maps: [0] } };
  assert.match(summary(alone), /^1 of 1 hang on the plan floor\.png, /, "of one map there is no more to tell");
});

test("a probability is never rounded to certainty", () => {
  assert.equal(probability(0.99996), "> 0.999");
  assert.equal(probability(1e-9), "< 0.001");
  assert.equal(probability(0.8), "0.800");
  assert.equal(probability(0), "0.000");
});

test("rows of refused joins become joins of which nothing in common is told", () => {
  const report = reportOf([{ x: 0, y: 0, theta: 0 }, { x: 1, y: 0, theta: 0 }, { x: 2, y: 0, theta: 0 }]);
  const before = report.joins.length;
  report.refused = { count: 7, rows: [[0, 2, "ambiguous", 0.25, 1, -2, 0.5]] };
  expandRefused(report);
  assert.equal(report.joins.length, before + 1);
  const join = report.joins[before];
  assert.deepEqual([join.fixed, join.moving, join.outcome, join.reason, join.probability], [0, 2, "refused", "ambiguous", 0.25]);
  assert.deepEqual(join.hypotheses.map(({ transform }) => transform), [{ x: 1, y: -2, theta: 0.5 }]);
  assert.equal(hasFigures(join), false);
  assert.deepEqual(report.refused, { count: 6, rows: [] });
});

test("of more than 50 maps lists are searched", () => {
  const poses = [...Array(51).keys()].map((x) => ({ x, y: 0, theta: 0 }));
  assert.equal(isLarge(reportOf(poses, [])), true);
  assert.equal(isLarge(reportOf(poses.slice(1), [])), false);
});

test("a deviation is never told as none", () => {
  assert.equal(sayDeviation({ position: 0.00033, theta: 0.00003 }), "± below 0.001 m, ± below 0.01°");
  assert.equal(sayDeviation({ position: 0.0126, theta: 0.02 }), "± 0.013 m, ± 1.15°");
  assert.equal(sayDeviation({ position: 0, theta: 0 }), "± 0.000 m, ± 0.00°");
});

test("a plan that is smaller than drawn is not called enlarged", () => {
  const plan = { name: "floor.png", scale: 0.9969, probability: 0.9996, maps: [0], places: [], grid: null };
  assert.match(summary({ ...reportOf([identity, identity]), plan }), /floor\.png, scaled by 0\.9969 \(/);
});

test("the page's title says what of", () => {
  const report = reportOf([identity, identity, identity, identity]);
  report.maps.forEach((map, i) => { map.name = `runs/${i}\u061c.yaml`; });
  assert.equal(pageTitle(report), "Merged maps: 0\ufffd.yaml, 1\ufffd.yaml and 2 more – gridmerge");
  assert.equal(pageTitle({ ...report, components: [], maps: report.maps.slice(0, 2) }), "Maps, none merged: 0\ufffd.yaml, 1\ufffd.yaml – gridmerge");
});

test("marks of direction are no part of a text that cannot isolate them", () => {
  for (const mark of "\u061c\u200e\u200f\u202a\u202e\u2066\u2069") assert.equal(flat(`a${mark}b`), "a\ufffdb");
});

test("maps are found by their whole names, and not by a folder that all lie in", () => {
  const report = reportOf([identity, identity]);
  report.maps.forEach((map, i) => { map.name = `/runs/robots/robot_${i}.yaml`; });
  const state = new State(report);
  const found = (query: string) => {
    state.search(query);
    return [0, 1].filter((map) => state.isFound(map));
  };
  assert.deepEqual([found("robot_1"), found("robots/robot_1"), found("/runs/robots/robot_0.yaml"), found("robots")], [[1], [1], [0], []]);
});
