// SPDX-License-Identifier: Apache-2.0
import { Grid } from "../src/grid";
import type { SE2 } from "../src/se2";

/** Numbers in [0, 1), the same for the same seed (the generator is mulberry32). */
export function randomNumbers(seed: number): () => number {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), state | 1);
    t = (t + Math.imul(t ^ (t >>> 7), t | 61)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

export function randomPose(random: () => number, reach = 20): SE2 {
  const number = () => (random() - 0.5) * 2 * reach;
  return { x: number(), y: number(), theta: (random() - 0.5) * 2 * Math.PI };
}

export function randomGrid(random: () => number, width: number, height: number, resolution = 0.1, origin?: SE2): Grid {
  const cells = Uint8Array.from({ length: width * height }, () => Math.floor(random() * 3));
  return new Grid(width, height, resolution, origin ?? { x: 0, y: 0, theta: 0 }, cells);
}
