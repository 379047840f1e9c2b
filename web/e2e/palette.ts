// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { type Rgb, disagreement, ink, parseColor, sepia, white } from "../src/color";
import { mergeInto, reportData, six } from "./reports";

/** What people without one kind of cone see, in linear light (Machado, Oliveira & Fernandes 2009, severity 1). */
const sights: Record<string, number[][]> = {
  usual: [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
  protanopia: [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
  deuteranopia: [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.01182, 0.04294, 0.968881]],
  tritanopia: [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.3039]],
};

function times(matrix: number[][], v: number[]): number[] {
  return matrix.map((row) => row.reduce((sum, value, i) => sum + value * v[i], 0));
}

/** CIE L*a*b* (D65) of linear sRGB. */
function lab(linear: number[]): number[] {
  const xyz = times([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]], linear);
  const [x, y, z] = xyz.map((value, i) => value / [0.9505, 1, 1.089][i])
    .map((t) => (t > 216 / 24389 ? Math.cbrt(t) : ((24389 / 27) * t + 16) / 116));
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}

function seen(color: Rgb, matrix: number[][]): number[] {
  const linear = color.map((channel) => {
    const c = channel / 255;
    return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
  });
  return lab(times(matrix, linear).map((value) => Math.min(1, Math.max(0, value))));
}

/** CIE 1976 colour difference; about 2 is just noticeable side by side. */
function difference(a: number[], b: number[]): number {
  return Math.hypot(...a.map((value, i) => value - b[i]));
}

test("colours of maps, of a plan, of disagreement, of shared walls and of free space differ for every kind of colour vision", (t) => {
  const colors = reportData(mergeInto("six", six())).maps.map((map) => map.color);
  assert.equal(colors.length, 6);
  const named: [string, Rgb][] = [...colors.map((color): [string, Rgb] => [color, parseColor(color)]),
    ["disagreement", disagreement], ["ink", ink], ["white", white], ["plan", sepia]];
  for (const [sight, matrix] of Object.entries(sights)) {
    let least: [number, string] = [Infinity, ""];
    for (let i = 0; i < named.length; i++) {
      for (let j = 0; j < i; j++) {
        const apart = difference(seen(named[i][1], matrix), seen(named[j][1], matrix));
        if (apart < least[0]) least = [apart, `${named[i][0]} and ${named[j][0]}`];
      }
    }
    t.diagnostic(`${sight}: least difference ${least[0].toFixed(1)}, ${least[1]}`);
    assert.ok(least[0] >= 15, `${sight}: ${least[1]} differ by ${least[0].toFixed(1)} only`);
  }
});
