// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { decision, needsExplanation, outcomeMeaning, ownVerdict, placementOf, withoutWitnesses } from "../src/decision";
import { type Join, heading, isUsed, outcomes } from "../src/report";
import { type SE2, identity } from "../src/se2";
import { join, reportOf } from "./reports";

const refusals = ["ambiguous", "contradiction", "too_little_overlap", "several", "nothing_to_compare"];
const placements = ["together", "apart", "one left out", "both left out"] as const;

/** Joins of every outcome and reason, each with every verdict of the two maps by themselves. */
function everyJoin(): Join[] {
  const own: Join["by_themselves"][] = [null, { verdict: "accepted", reason: null },
    ...[...refusals, null].map((reason) => ({ verdict: "refused" as const, reason }))];
  return outcomes.flatMap((outcome) => [null, ...refusals, "contradicts_others", "over_budget"].flatMap((reason) =>
    own.map((by_themselves) => join(0, 1, identity, {
      outcome, reason, by_themselves, hypotheses: [{ transform: identity, score: 1, probability: 0.9996 }],
    }))));
}

test("what is said of a join contradicts nothing else that is said of it", () => {
  for (const one of everyJoin()) {
    for (const placement of placements) {
      const decided = decision(one, placement);
      const said = [`${decided}.`, ...(needsExplanation(one) ? [ownVerdict(one), withoutWitnesses(one, placement)] : [])].join(" ");
      const about = `${one.outcome}, ${one.reason}, ${JSON.stringify(one.by_themselves)}, ${placement}: ${said}`;
      const isBelieved = one.by_themselves?.verdict === "accepted";
      assert.ok(!/undefined|null|_/.test(said.replace(one.reason ?? "", "")), about);
      assert.ok(decided.split(" ").length <= 25, about);
      for (const words of said.match(/contradicts the other maps/g)?.slice(1) ?? []) assert.fail(`${words} twice: ${about}`);
      if (isBelieved) assert.ok(!/not believed/.test(said), about);
      if (!isUsed(one) && isBelieved) assert.match(said, /By themselves they would be joined/, about);
      if (one.outcome === "refused") assert.equal(/budget of false joins/.test(decided), one.reason === "over_budget", about);
      if (placement !== "together") assert.ok(!/chains of joins/.test(said), about);
      if (placement === "one left out" && one.outcome === "rejected" && isBelieved) {
        assert.match(said, /no join of the one that is left out/, about);
        assert.ok(!/a pose that was given/.test(said), about);
      }
    }
  }
});

test("what an outcome means holds for all its joins", () => {
  for (const one of everyJoin()) {
    const isBelieved = one.by_themselves?.verdict === "accepted";
    if (!isUsed(one) && !isBelieved) assert.ok(!/would be believed/.test(outcomeMeaning[one.outcome]), one.outcome);
  }
});

test("it is told whether the merge has two maps together", () => {
  const report = reportOf([identity, identity, identity, identity, identity, identity]);
  const component = (...maps: number[]) => ({ ...report.components[0], members: maps.map((map) => report.components[0].members[map]) });
  report.components = [component(0, 1), component(2, 3)];
  const of = (fixed: number, moving: number, T: SE2 = identity) => placementOf(report, join(fixed, moving, T));
  assert.deepEqual([of(0, 1), of(1, 2), of(3, 4), of(5, 0), of(4, 5)], ["together", "apart", "one left out", "one left out", "both left out"]);
});

test("the heading does not call merged what is not", () => {
  const report = reportOf([identity, identity]);
  assert.equal(heading(report), "Merged maps");
  assert.equal(heading({ ...report, components: [] }), "Maps, none merged");
  const one = { ...reportOf([identity]), components: [] };
  assert.equal(heading(one), "One map");
  const plan = { name: "floor.png", scale: 1, probability: 1, maps: [0], places: [], grid: null };
  assert.equal(heading({ ...one, plan }), "Map on a plan");
  assert.equal(heading({ ...one, plan: { ...plan, maps: [] } }), "One map");
});
