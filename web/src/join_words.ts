// SPDX-License-Identifier: Apache-2.0
import { mapLabel } from "./badge";
import { h } from "./dom";
import { degrees, fixed, probability } from "./numbers";
import { type Join, reasons } from "./report";
import type { State } from "./state";
import { count } from "./text";
import type { Offset, Witness } from "./witnesses";

// Why the merge decides as it does, in sentences.

/** So many other maps are named one by one. */
const mostListed = 3;

/** "0.12 m and 0.4°". */
export function sayOffset({ distance, angle }: Offset): string {
  return `${fixed(distance, 2)} m and ${fixed(degrees(angle), 1)}°`;
}

/** What the two maps say by themselves. */
export function ownVerdict(join: Join): string {
  const { verdict, reason } = join.by_themselves;
  const ways = join.hypotheses.slice(0, 2).map((way, i) => `way ${i + 1} (${probability(way.probability)})`);
  const likely = ways.length === 0 ? "" : ` The most probable: ${ways.join(", ")}.`;
  if (verdict === "accepted") return `By themselves they would be joined in way 1.${likely}`;
  const why = reason === null ? "nothing speaks for one way clearly enough" : reasons[reason] ?? reason;
  return `By themselves they would not be joined: ${why}.${likely}`;
}

/** What the other maps say of where the merge lays the two. */
export function sayWitnesses(state: State, witnesses: Witness[]): HTMLElement {
  if (witnesses.length === 0) {
    return h("span", {}, "No other map is joined to both: what speaks here are longer chains of joins, or a pose that was given.");
  }
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
