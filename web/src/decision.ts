// SPDX-License-Identifier: Apache-2.0
import { probability } from "./numbers";
import { type Join, type Outcome, type Report, isUsed } from "./report";

// What the merge made of a join, and why, in sentences: each holds for the join's outcome, its reason, what the two maps say by
// themselves, and where the merge has put them.

/** Whether the merge has the two maps in one merged map, in two, or has left out one of them or both. */
export type Placement = "together" | "apart" | "one left out" | "both left out";

/** Of all joins of an outcome, whatever the two maps say by themselves. */
export const outcomeMeaning: Record<Outcome, string> = {
  accepted: "believed by itself",
  rescued: "too weak by itself, but it agrees with the other maps, or with a pose that was given",
  known: "they lie so because their poses were given",
  rejected: "contradicts the other maps, or a pose that was given",
  refused: "not believed, or too doubtful for the budget of false joins",
};

const reasons: Record<string, string> = {
  ambiguous: "another way to lay them fits nearly as well",
  contradiction: "too much of what both know contradicts",
  too_little_overlap: "too little in common",
  several: "several things speak against it",
  nothing_to_compare: "there is too little in them to compare",
  contradicts_others: "it contradicts the other maps",
};

export function placementOf(report: Report, join: Join): Placement {
  const home = (map: number) => report.components.findIndex(({ members }) => members.some((member) => member.map === map));
  const [fixed, moving] = [home(join.fixed), home(join.moving)];
  if (fixed < 0 || moving < 0) return fixed < 0 && moving < 0 ? "both left out" : "one left out";
  return fixed === moving ? "together" : "apart";
}

/** What follows the outcome's name; without a full stop. */
export function decision(join: Join, placement: Placement): string {
  const isBelieved = join.by_themselves?.verdict === "accepted";
  switch (join.outcome) {
    case "accepted":
    case "known":
      return outcomeMeaning[join.outcome];
    case "rescued":
      return isBelieved ? "believed by itself in another way, but the other maps, or a pose that was given, speak for this one"
        : outcomeMeaning.rescued;
    case "rejected": {
      const others = placement === "together" ? "the other maps, or a pose that was given, lay the two otherwise"
        : "it contradicts the other maps";
      return `${isBelieved ? "would be believed by itself" : "not believed by itself"}, ${isBelieved ? "but" : "and"} ${others}`;
    }
    case "refused":
      return refusal(join, isBelieved);
  }
}

function refusal({ reason }: Join, isBelieved: boolean): string {
  if (reason === "over_budget") return "it would be used, but it is too doubtful for the budget of false joins (--max-false-joins)";
  if (isBelieved) return "would be believed by itself, but another way to lay them, or another join, is as good";
  return reason === null ? "not believed" : `not believed: ${reasons[reason] ?? reason}`;
}

/** Whether the merge decides otherwise than the two maps by themselves, or for another reason. */
export function needsExplanation(join: Join): boolean {
  if (join.outcome === "rescued") return true;
  const own = join.by_themselves;
  return !isUsed(join) && own !== null && (own.verdict === "accepted" || own.reason !== join.reason);
}

/** What the two maps say by themselves. */
export function ownVerdict(join: Join): string {
  if (join.by_themselves === null) return "";
  const { verdict, reason } = join.by_themselves;
  const ways = join.hypotheses.slice(0, 2).map((way, i) => `way ${i + 1} (${probability(way.probability)})`);
  const likely = ways.length === 0 ? "" : ` The most probable: ${ways.join(", ")}.`;
  if (verdict === "accepted") return `By themselves they would be joined in way 1.${likely}`;
  const why = reason === null ? "nothing speaks for one way clearly enough" : reasons[reason] ?? reason;
  return `By themselves they would not be joined: ${why}.${likely}`;
}

/** What speaks for a rescued join or against a rejected one if no other map is joined to both; empty for other joins. */
export function withoutWitnesses(join: Join, placement: Placement): string {
  if (join.outcome !== "rescued" && join.outcome !== "rejected") return "";
  switch (placement) {
    case "together":
      return "No other map is joined to both: what speaks here are longer chains of joins, or a pose that was given.";
    case "apart":
      return "They are in different merged maps. To lay the two so would lay these over each other, and other comparisons speak against that.";
    case "one left out":
      return "The merge uses no join of the one that is left out. Where this join would put it, comparisons with other maps speak against it.";
    case "both left out":
      return "";
  }
}
