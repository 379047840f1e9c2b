// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { type SharedView, defaultView, fromHash, isForeign, toHash } from "../src/link";
import type { SE2 } from "../src/se2";
import { randomNumbers } from "./random";
import { join, reportOf } from "./reports";

const at = { x: 0, y: 0, theta: 0 };
const ways = [1, 2, 3].map((probability) => ({ transform: at, score: 0, probability }));
const report = reportOf([at, at, at], [join(0, 1, at, { hypotheses: ways }), join(0, 2, at)]);
const tabs = ["layers", "joins", "transforms", "hand"];

test("a report as it is opened needs no hash", () => {
  assert.equal(toHash(defaultView(report), report), "");
  assert.deepEqual(fromHash("", report, tabs), defaultView(report));
});

test("any view comes back from its link", () => {
  const random = randomNumbers(31);
  const thousandths = (size: number) => Math.round((random() - 0.5) * size * 1000) / 1000;
  const share = () => Math.round(random() * 1000) / 1000;
  const point = () => ({ x: thousandths(500), y: thousandths(500) });
  const scenes: SharedView["scene"][] = [{ kind: "component", component: 0 }, { kind: "map", map: 2 },
    { kind: "join", join: 0, hypothesis: 2 }, { kind: "join", join: 1, hypothesis: -1 }];
  for (let i = 0; i < 200; i++) {
    const isAimed = random() < 0.8;
    const view: SharedView = {
      scene: scenes[Math.floor(random() * 4)], center: isAimed ? point() : null, metres: isAimed ? 0.001 + share() * 100 : 0,
      tab: tabs[Math.floor(random() * 4)], merged: share(), agreement: share(), plan: share(),
      maps: new Map(random() < 0.5 ? [[0, share() / 2], [2, 0]] : []), grid: random() < 0.5,
      bent: Math.floor(random() * 11) / 10, arrows: random() < 0.5,
      colors: new Map(random() < 0.5 ? [[1, "#0a00ff"]] : []),
      placed: new Map(random() < 0.5 ? [[1, { ...point(), theta: thousandths(6) }], [2, { ...point(), theta: 0 }]] : []),
      ruler: random() < 0.5 ? { from: point(), to: point() } : null,
    };
    view.metres = Math.round(view.metres * 1000) / 1000;
    for (const [map, opacity] of view.maps) view.maps.set(map, Math.round(opacity * 1000) / 1000);
    const hash = toHash(view, report);
    assert.match(hash, /^[a-z0-9=&:;,.-]*$/, "nothing that a mail or a chat would break");
    assert.deepEqual(fromHash(`#${hash}`, report, tabs), view);
  }
});

test("poses come back to the bit, however far off they are", () => {
  const poses: [number, SE2][] = [[0, { x: 500101.123456789, y: 4649776.1, theta: 0.7123456789012345 }], [1, { x: -1 / 3, y: 1e-9, theta: -1e-7 }],
    [2, { x: -0.1, y: 9999999.999, theta: Math.PI }]];
  const placed = new Map(poses);
  const hash = toHash({ ...defaultView(report), placed }, report);
  assert.match(hash, /^[a-z0-9=&:;,.-]*$/);
  assert.deepEqual(fromHash(hash, report, tabs).placed, placed);
});

test("a link of another merge moves, hides and colours no map", () => {
  const of = { ...report, merge: "fedcba9876543210" };
  const view: SharedView = {
    ...defaultView(report), scene: { kind: "map", map: 2 }, center: { x: 1, y: 2 }, metres: 3, tab: "joins", merged: 0.5, maps: new Map([[0, 0]]),
    colors: new Map([[1, "#0a00ff"]]), placed: new Map([[1, at]]), grid: false, ruler: { from: { x: 1, y: 2 }, to: { x: 3, y: 4 } },
  };
  const hash = toHash(view, report);
  assert.deepEqual(fromHash(hash, report, tabs), view);
  assert.equal(isForeign(hash, report), false);
  assert.equal(isForeign(hash, of), true);
  assert.deepEqual(fromHash(hash, of, tabs), { ...defaultView(of), tab: "joins", merged: 0.5, grid: false }, "what is of any merge holds");
  assert.equal(isForeign(toHash({ ...defaultView(report), tab: "joins" }, report), of), false, "nor is there anything of maps in it");
  assert.equal(isForeign("#placed=1:1,2,0.5", of), false, "a link of before");
});

test("what is damaged, or of another report, is left as it is", () => {
  for (const hash of ["#", "#show=join-0-3", "#show=join-0", "#show=join-9-0", "#show=merged-1", "#show=map-3", "#show=map--1", "#at=1,2",
    "#at=1,2,0", "#at=1,2,-5", "#at=1e999,2,3", "#at=NaN,0,1", "#at=Infinity,0,1", "#at=9999999999,0,1", "#tab=evil", "#merged=2",
    "#merged=-1", "#maps=7:0.5", "#colors=0:red", "#colors=9:00ff00", "#colors=0:00ff00ff", "#placed=9:1,2,3", "#placed=0:1,2", "#placed=0:1,2,x", "#placed=0:10000001,0,0", "#maps=0:x", "#maps=__proto__:0", "#ruler=1,2,3", "#%00", "#grid", "#====&&&&", "#show=<script>"]) {
    assert.deepEqual(fromHash(hash, report, tabs), defaultView(report), hash);
  }
  assert.equal(fromHash("#tab=joins&at=oops&merged=1", report, tabs).merged, 1, "the rest holds");
});
