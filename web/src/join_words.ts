// SPDX-License-Identifier: Apache-2.0
import { mapLabel } from "./badge";
import { h } from "./dom";
import { degrees, fixed } from "./numbers";
import type { State } from "./state";
import { count } from "./text";
import type { Offset, Witness } from "./witnesses";

// What other maps say of a join, in sentences.

/** So many other maps are named one by one. */
const mostListed = 3;

/** "0.12 m and 0.4°". */
export function sayOffset({ distance, angle }: Offset): string {
  return `${fixed(distance, 2)} m and ${fixed(degrees(angle), 1)}°`;
}

/** What the other maps say of where the merge lays the two, if there are any. */
export function sayWitnesses(state: State, witnesses: Witness[]): HTMLElement {
  const tell = ({ map, offset }: Witness) => h("span", {}, mapLabel(state, map), ` ${sayOffset(offset)}`);
  const joined = `${count(witnesses.length, "other map")} ${witnesses.length === 1 ? "is" : "are"} joined to both.`;
  if (witnesses.length <= mostListed) {
    const all = witnesses.flatMap((witness, i) => [i > 0 ? ", " : "", tell(witness)]);
    return h("span", {}, `${joined} Over ${witnesses.length === 1 ? "it" : "them"} the second map lies off by `, ...all, ".");
  }
  const half = witnesses[Math.ceil(witnesses.length / 2) - 1];
  return h("span", {}, `${joined} Over half of them the second map lies off by at most ${fixed(half.offset.distance, 2)} m: nearest `,
    tell(witnesses[0]), ", farthest ", tell(witnesses[witnesses.length - 1]), ".");
}
