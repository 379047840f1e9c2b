// SPDX-License-Identifier: Apache-2.0
import type { Grid } from "./grid";
import type { Placed } from "./scene";
import { Scorer } from "./score";
import { type SE2, apply } from "./se2";
import { boxAround } from "./viewport";

/** So many poses show what a map meets by chance. */
const chancePoses = 40;
/** At such a pose others have seen so great a share of its walls at least. */
const leastSeen = 0.1;
/** So many of the maps that were joined show what they have. */
const mostMembers = 20;

/** Against what a share of walls met can be held. */
export interface Yardstick {
  /** The least and the most that maps of the merge, twenty at most, have where they were joined; null where none were. */
  joined: { least: number; most: number } | null;
  /** What the map in hand does not exceed in 19 of 20 places anywhere that others have seen a tenth of its walls; null if there are none. */
  chance: number | null;
}

interface Laid {
  grid: Grid;
  pose: SE2;
}

/**
 * Works out a yardstick a step at a time, so that a page goes on answering: a step scores one map at one pose.
 * O(samples * maps) a step.
 */
export function* yardstickOf(scorer: Scorer, grid: Grid, others: Laid[], members: Laid[]): Generator<undefined, Yardstick> {
  const joined: number[] = [];
  const step = Math.ceil(members.length / mostMembers);
  for (const member of members.filter((_, i) => i % step === 0)) {
    const score = new Scorer(member.grid).score(member.pose, members.filter((other) => other !== member));
    if (score) joined.push(score.wallsMet);
    yield;
  }
  const shares: number[] = [];
  for (let i = 0; i < chancePoses; i++) {
    const score = scorer.score(chancePose(i, grid, others), others);
    // A handful of walls meets others by chance, and says nothing of a place where most are seen.
    if (score && score.wallsSeen >= leastSeen) shares.push(score.wallsMet);
    yield;
  }
  return {
    joined: joined.length === 0 ? null : { least: Math.min(...joined), most: Math.max(...joined) },
    chance: highOf(shares),
  };
}

/** Maps of which the cells are there, as `gridOf` has them. */
export function laid(placed: readonly Placed[], gridOf: (placed: Placed) => Grid | null): Laid[] {
  return placed.flatMap((one) => {
    const grid = gridOf(one);
    return grid ? [{ grid, pose: one.T_scene_map }] : [];
  });
}

/**
 * Pose `i` of a map that is laid anywhere: its middle evenly over the rectangle that the others cover, its direction evenly
 * over all. The sequence is the same each time: multiples of the powers of 1 / 1.22074, which fill a cube evenly (Roberts, 2018,
 * "The unreasonable effectiveness of quasirandom sequences").
 */
function chancePose(i: number, grid: Grid, others: Laid[]): SE2 {
  const box = boxAround(others.flatMap((other) => other.grid.corners(other.pose)));
  const part = (step: number) => (0.5 + (i + 1) * step) % 1;
  const turn = { x: 0, y: 0, theta: 2 * Math.PI * (part(0.5497005) - 0.5) };
  const from = apply(turn, grid.middle());
  return {
    x: box.left + part(0.8191725) * (box.right - box.left) - from.x,
    y: box.bottom + part(0.6710436) * (box.top - box.bottom) - from.y,
    theta: turn.theta,
  };
}

/** What all but a twentieth do not exceed; null of none. */
function highOf(shares: number[]): number | null {
  const sorted = [...shares].sort((a, b) => a - b);
  return sorted[Math.max(0, Math.ceil(0.95 * sorted.length) - 1)] ?? null;
}
