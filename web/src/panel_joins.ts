// SPDX-License-Identifier: Apache-2.0
import { mapLabel } from "./badge";
import { decision, needsExplanation, outcomeMeaning, ownVerdict, placementOf, withoutWitnesses } from "./decision";
import { h, replace } from "./dom";
import { describe } from "./formats";
import { joinGraph } from "./join_graph";
import { joinMatrix } from "./join_matrix";
import { JoinTable } from "./join_table";
import { sayOffset, sayWitnesses } from "./join_words";
import { fixed, percent, probability } from "./numbers";
import { type Join, type Outcome, hasFigures, hasWay, isLarge, isUsed, outcomes } from "./report";
import type { SE2 } from "./se2";
import { searchBox } from "./search";
import type { State } from "./state";
import { count } from "./text";
import { mergedPose, offsetOf, witnessesOf } from "./witnesses";

/** More joins than this crowd the graph: those that were not used are then hidden at first. */
const crowded = 15;
/** Of more maps than this, all joined to each other, a graph is a tangle: then there is a matrix. */
const mostInGraph = 8;

/** Every comparison that the merge made: as a graph or a matrix, as a table, and one of them in full. */
export class JoinsPanel {
  readonly element = h("div", { class: "panel", id: "panel-joins", tabindex: -1 });
  readonly table: JoinTable;
  private readonly state: State;
  private readonly chosen = h("section", { class: "chosen-join" });
  private readonly graph = h("div");
  private readonly shown: Set<Outcome>;
  private readonly placeByHand: (map: number, on: number, T_on_map: SE2) => void;

  constructor(state: State, actions: { placeByHand(map: number, on: number, T_on_map: SE2): void }) {
    this.state = state;
    this.placeByHand = actions.placeByHand;
    const all = state.report.joins.length <= crowded;
    this.shown = new Set(outcomes.filter((outcome) => all || outcome !== "refused"));
    if (state.report.joins.every((join) => !this.shown.has(join.outcome))) this.shown.add("refused");
    this.table = new JoinTable(state, this.shown, (join) => this.goTo(join));
    replace(this.element, this.chosen, isLarge(state.report) ? searchBox(state) : null, this.filters(), this.graph, this.table.element);
    state.on("query", () => this.table.update());
    for (const topic of ["scene", "colors"] as const) state.on(topic, () => this.update());
    // Distances are given at a map's middle, which is known with its cells.
    state.on("grids", () => this.showChosen());
    this.update();
  }

  private filters(): HTMLElement {
    const counts = outcomes.map((outcome) => this.state.report.joins.filter((join) => join.outcome === outcome).length
      + (outcome === "refused" ? this.state.report.refused.count : 0));
    const boxes = outcomes.map((outcome, i) => {
      const box = h("input", {
        type: "checkbox", id: `outcome-${outcome}`, "data-kept": true, change: () => {
          if (box.checked) this.shown.add(outcome);
          else this.shown.delete(outcome);
          this.update();
        },
      });
      box.checked = this.shown.has(outcome);
      return counts[i] === 0 ? null
        : h("label", { class: `outcome ${outcome}`, title: outcomeMeaning[outcome] }, box, `${outcome} (${counts[i]})`);
    });
    return h("div", { class: "filters", role: "group", "aria-label": "Which joins are shown" }, ...boxes);
  }

  private update(): void {
    if (!isLarge(this.state.report)) this.draw();
    this.table.update();
    this.showChosen();
  }

  private draw(): void {
    const isMatrix = this.state.report.maps.length > mostInGraph;
    const drawing = (isMatrix ? joinMatrix : joinGraph)(this.state, this.shown, (join) => this.goTo(join));
    replace(this.graph, drawing, isMatrix ? h("p", { class: "soft" },
      "A square for each two maps: full if accepted, hollow if rescued, broken if not used; the larger, the more they have in common.") : null);
  }

  /** A hypothesis of -1: as the merge has it, if that is none of the two maps' own. */
  choose(join: number, hypothesis = mergedHypothesis(this.state.report.joins[join])): void {
    this.state.show({ kind: "join", join, hypothesis });
  }

  /** What is said of the join stands at the top: most of it is longer than the panel. */
  goTo(join: number): void {
    this.choose(join);
    this.chosen.scrollIntoView({ block: "start" });
  }

  /** For who comes from elsewhere, whose focus is lost with what was there. */
  focus(): void {
    this.chosen.querySelector<HTMLElement>("button.back")?.focus({ preventScroll: true });
  }

  private goBack(join: number): void {
    this.state.show(this.state.whole);
    // A filter or the search may hide its row.
    if (!this.table.focus(join, true)) this.element.focus();
  }

  private showChosen(): void {
    const { id } = this.state.scene;
    if (id.kind !== "join") {
      replace(this.chosen, h("p", { class: "soft" },
        `${count(this.state.report.joins.length + this.state.report.refused.count, "comparison")}. Choose one to see just its two maps, and the other ways in which they may lie.`));
      return;
    }
    const join = this.state.report.joins[id.join];
    replace(this.chosen,
      h("h3", {}, mapLabel(this.state, join.fixed), h("span", { class: "soft" }, " and "), mapLabel(this.state, join.moving)),
      h("p", {}, h("strong", { class: `outcome ${join.outcome}` }, join.outcome), `: ${decision(join, placementOf(this.state.report, join))}.`),
      needsExplanation(join) ? this.explain(join) : null,
      !hasWay(join) ? h("p", { class: "soft" }, "So there is no way to show how they lie.")
        : hasFigures(join) || !isLarge(this.state.report) ? figures(join, id.hypothesis) : null, this.hypotheses(join, id.join, id.hypothesis),
      h("div", { class: "buttons" },
        h("button", { type: "button", class: "back", click: () => this.goBack(id.join) }, "Back to the whole"),
        !hasWay(join) ? null : h("button", {
          type: "button", class: "adopt", title: "Take the second map in hand, as it lies here, to save its pose for the next merge",
          click: () => this.placeByHand(join.moving, join.fixed, this.state.poseOf(join.moving)!),
        }, "Place it so by hand")));
  }

  /** Why the merge decides otherwise than the two maps by themselves. */
  private explain(join: Join): HTMLElement {
    const { report } = this.state;
    const merged = mergedHypothesis(join);
    const way = join.hypotheses.length === 0 || join.outcome === "refused" ? null
      : merged >= 0 ? `way ${merged + 1}` : "a way that is none of theirs";
    const lays = join.outcome === "rescued" ? "The merge lays them in" : "The merge does not lay them in";
    const witnesses = witnessesOf(report, join, this.middleOf(join.moving));
    return h("ul", { class: "explanation" },
      h("li", {}, ownVerdict(join)),
      h("li", {}, way === null ? null : `${lays} ${way}, whose own probability is ${probability(join.probability)}.`),
      h("li", {}, witnesses.length > 0 ? sayWitnesses(this.state, witnesses) : withoutWitnesses(join, placementOf(report, join))));
  }

  private hypotheses(join: Join, index: number, current: number): HTMLElement | null {
    if (join.hypotheses.length === 0) return null;
    const merged = mergedHypothesis(join);
    const T_merged = mergedPose(this.state.report, join);
    const option = (hypothesis: number, transform: SE2, ...label: (string | HTMLElement)[]) => {
      const radio = h("input", {
        type: "radio", name: "hypothesis", value: hypothesis, change: () => {
          this.choose(index, hypothesis);
          this.chosen.querySelector<HTMLInputElement>(`input[value="${hypothesis}"]`)?.focus();
        },
      });
      radio.checked = hypothesis === current;
      const off = T_merged ? `, ${sayOffset(offsetOf(transform, T_merged, this.middleOf(join.moving)))} off` : null;
      return h("label", { class: "hypothesis" }, radio, h("span", {}, ...label, off,
        h("br"), h("span", { class: "soft" }, describe(transform))));
    };
    return h("fieldset", { class: "hypotheses" },
      h("legend", {}, T_merged ? "Ways, and how far off the merged map" : "Ways in which they may lie"),
      merged >= 0 || !isUsed(join) ? null : option(-1, join.transform, h("strong", {}, "as merged")),
      ...join.hypotheses.map(({ transform, probability: own }, i) => option(i, transform,
        `${i + 1}: probability ${probability(own)}`, i === merged && isUsed(join) ? h("strong", {}, " (as merged)") : "")));
  }

  private middleOf(map: number): { x: number; y: number } {
    return this.state.grids[map]?.middle() ?? { x: 0, y: 0 };
  }
}

/** The hypothesis that the merge uses, or would use; -1 if it is none of them. */
function mergedHypothesis(join: Join): number {
  const same = JSON.stringify(join.transform);
  return join.hypotheses.findIndex((hypothesis) => JSON.stringify(hypothesis.transform) === same);
}

/** The engine counts cells for the pose that the merge uses, or would use, alone. */
function figures(join: Join, shown: number): HTMLElement {
  const counted = mergedHypothesis(join);
  const pairs: [string, string][] = [
    ["Probability", probability(shown < 0 ? join.probability : join.hypotheses[shown].probability)],
    ["Acceptance index", fixed(join.acceptance_index, 4)],
    ["Cells that agree", String(join.agreement)],
    ["Cells that do not", String(join.disagreement)],
    ["Overlap", percent(join.overlap)],
  ];
  const list = h("dl", { class: "figures" }, ...pairs.flatMap(([term, value]) => [h("dt", {}, term), h("dd", {}, value)]));
  const whose = counted < 0 ? "the way that is merged" : `way ${counted + 1}`;
  return h("div", {}, list, shown === counted || join.hypotheses.length === 0 ? null
    : h("p", { class: "soft" }, `Index, cells and overlap are those of ${whose}.`));
}
