// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { type Point } from "../src/se2";
import { boxAround, fit, looking, multiples, panned, roundStep, toScene, toScreen, visibleBox, zoomed } from "../src/viewport";
import { randomNumbers } from "./random";

function near(a: Point, b: Point): void {
  assert.ok(Math.hypot(a.x - b.x, a.y - b.y) < 1e-6, `${JSON.stringify(a)} is not ${JSON.stringify(b)}`);
}

test("screen and scene are each other's inverse, with y up in the scene", () => {
  const random = randomNumbers(1);
  const view = { width: 800, height: 600, center: { x: 3, y: -4 }, scale: 25 };
  for (let i = 0; i < 100; i++) {
    const p = { x: random() * 800, y: random() * 600 };
    near(toScreen(view, toScene(view, p)), p);
  }
  near(toScreen(view, { x: 3, y: -3 }), { x: 400, y: 275 });
});

test("fitting shows the whole box", () => {
  for (const [width, height] of [[800, 600], [200, 900]]) {
    const box = { left: -3, bottom: 2, right: 50, top: 20 };
    const seen = visibleBox(fit(box, width, height));
    assert.ok(seen.left < box.left && seen.right > box.right && seen.bottom < box.bottom && seen.top > box.top);
  }
  assert.ok(Number.isFinite(fit(boxAround([]), 100, 100).scale));
  assert.ok(fit(boxAround([{ x: 1, y: 1 }]), 100, 100).scale <= 200, "half a metre, of a map without cells");
});

test("zooming holds what is under the pointer, within bounds", () => {
  const view = { width: 800, height: 600, center: { x: 3, y: -4 }, scale: 25 };
  const at = { x: 100, y: 500 };
  for (const factor of [0.1, 0.9, 1.7, 30, 1e9, 1e-9]) near(toScene(zoomed(view, factor, at), at), toScene(view, at));
  assert.ok(zoomed(view, 1e9, at).scale <= 2000 && zoomed(view, 1e-9, at).scale >= 0.01);
});

test("zooming out never comes nearer, however far the view is", () => {
  const far = looking({ x: 0, y: 0 }, 1e6, 800, 600);
  const at = { x: 400, y: 300 };
  assert.equal(zoomed(far, 0.5, at).scale, far.scale);
  assert.ok(zoomed(far, 1.5, at).scale > far.scale);
});

test("panning moves what is seen with the pointer", () => {
  const view = { width: 800, height: 600, center: { x: 3, y: -4 }, scale: 25 };
  near(toScene(panned(view, 30, -40), { x: 130, y: 460 }), toScene(view, { x: 100, y: 500 }));
});

test("steps are round and no smaller than asked", () => {
  const random = randomNumbers(2);
  for (let i = 0; i < 200; i++) {
    const least = 10 ** (random() * 6 - 3);
    const step = roundStep(least);
    assert.ok(step >= least * (1 - 1e-6) && step < 2.5 * least + 1e-12);
    const digit = Number(step.toExponential(6).split("e")[0]);
    assert.ok([1, 2, 5].includes(digit), `${step}`);
  }
});

test("a view looks no nearer than there is something to see, and no further than fits a number", () => {
  const center = { x: 999999999, y: 0 };
  for (const [metres, scale] of [[1e-10, 2000], [30, 20], [1e300, 1e-6], [Infinity, 1e-6]]) {
    assert.deepEqual(looking(center, metres, 800, 600), { width: 800, height: 600, center, scale });
  }
});

test("lines of a grid are counted, wherever they lie", () => {
  assert.deepEqual(multiples(0.5, -0.6, 1), [-0.5, 0, 0.5, 1]);
  assert.deepEqual(multiples(5, 1, 4), []);
  assert.deepEqual(multiples(5, 5, 5), [5]);
  assert.ok(multiples(1e-10, 1e9, 1e9 + 1e-6).length <= 1000);
  assert.ok(multiples(1e-9, -1e9, 1e9).length <= 1000);
  for (const nowhere of [NaN, Infinity]) assert.ok(multiples(1, 0, nowhere).length <= 1000);
});

test("a box is put around any number of points", () => {
  const points = Array.from({ length: 300000 }, (_, i) => ({ x: i, y: 1 - i }));
  assert.deepEqual(boxAround(points), { left: 0, bottom: -299998, right: 299999, top: 1 });
});
