// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { describeRuler, lengthOf, put } from "../src/ruler";

const empty = { from: null, to: null, open: false };

test("two points are a length, a third begins anew", () => {
  const begun = put(empty, { x: 1, y: 1 });
  assert.ok(begun.open);
  assert.equal(lengthOf(begun), "0.00 m");
  const ended = put({ ...begun, to: { x: 99, y: 99 } }, { x: 4, y: 5 });
  assert.deepEqual(ended, { from: { x: 1, y: 1 }, to: { x: 4, y: 5 }, open: false });
  assert.equal(lengthOf(ended), "5.00 m");
  assert.deepEqual(put(ended, { x: 7, y: 7 }).from, { x: 7, y: 7 });
});

test("it tells the length, its parts and its direction", () => {
  assert.equal(describeRuler({ from: { x: 1, y: 1 }, to: { x: 1, y: -1 }, open: false }), "2.00 m: x 0.00 m, y -2.00 m, -90.0°");
  assert.match(describeRuler(empty), /^Click/);
});
