// SPDX-License-Identifier: Apache-2.0
import { badge, mapLabel } from "./badge";
import { h, replace } from "./dom";
import { describe } from "./formats";
import { joinGraph, joinTitle } from "./join_graph";
import { fixed, percent, probability } from "./numbers";
import { type Join, type Outcome, isUsed, outcomeMeaning, outcomes } from "./report";
import type { SE2 } from "./se2";
import type { State } from "./state";
import { count } from "./text";

/** More joins than this crowd the graph: those that were not used are then hidden at first. */
const crowded = 15;

const reasons: Record<string, string> = {
  ambiguous: "another way to lay them fits nearly as well",
  contradiction: "too much of what both know contradicts",
  too_little_overlap: "too little in common",
  several: "several things speak against it",
  nothing_to_compare: "nothing to compare",
  contradicts_others: "contradicts the other maps",
};

/** Every comparison that the merge made: as a graph, as a table, and one of them in full. */
export class JoinsPanel {
  readonly element = h("div", { class: "panel", id: "panel-joins" });
  private readonly state: State;
  private readonly chosen = h("section", { class: "chosen-join" });
  private readonly graph = h("div");
  private readonly table = h("div", { class: "table" });
  private readonly shown: Set<Outcome>;
  private readonly placeByHand: (map: number, on: number, T_on_map: SE2) => void;

  constructor(state: State, actions: { placeByHand(map: number, on: number, T_on_map: SE2): void }) {
    this.state = state;
    this.placeByHand = actions.placeByHand;
    const all = state.report.joins.length <= crowded;
    this.shown = new Set(outcomes.filter((outcome) => all || outcome !== "refused"));
    if (state.report.joins.every((join) => !this.shown.has(join.outcome))) this.shown.add("refused");
    replace(this.element, this.chosen, this.filters(), this.graph, this.table);
    state.on("scene", () => this.update());
    state.on("colors", () => this.update());
    this.update();
  }

  private filters(): HTMLElement {
    const counts = outcomes.map((outcome) => this.state.report.joins.filter((join) => join.outcome === outcome).length);
    const boxes = outcomes.map((outcome, i) => {
      const box = h("input", {
        type: "checkbox", id: `outcome-${outcome}`, change: () => {
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
    const choose = (join: number) => this.choose(join);
    replace(this.graph, joinGraph(this.state, this.shown, choose));
    replace(this.table, this.makeTable());
    this.showChosen();
  }

  /** A hypothesis of -1: as the merge has it, if that is none of the two maps' own. */
  private choose(join: number, hypothesis = mergedHypothesis(this.state.report.joins[join])): void {
    this.state.show({ kind: "join", join, hypothesis });
    this.chosen.scrollIntoView({ block: "nearest" });
  }

  private goBack(join: number): void {
    this.state.show(this.state.whole);
    this.focusRow(join, true);
  }

  /** The table has been made anew, and the focus is lost with the old one. */
  private focusRow(join: number, scroll: boolean): void {
    this.table.querySelector<HTMLElement>(`button[data-join="${join}"]`)?.focus({ preventScroll: !scroll });
  }

  private makeTable(): HTMLElement {
    const { joins } = this.state.report;
    const rows = joins
      .map((join, index) => ({ join, index }))
      .filter(({ join }) => this.shown.has(join.outcome))
      .sort((a, b) => outcomes.indexOf(a.join.outcome) - outcomes.indexOf(b.join.outcome) ||
        b.join.probability - a.join.probability)
      .map(({ join, index }) => this.row(join, index));
    if (rows.length === 0) return h("p", { class: "soft" }, "No joins of these kinds.");
    return h("table", {},
      h("thead", {}, h("tr", {}, ...["Maps", "Outcome", "Probability", "Index", "Overlap"].map(
        (head, i) => h("th", {
          class: i > 1 ? "number" : "", scope: "col", title: head === "Index" ? "acceptance index" : head,
        }, head)))),
      h("tbody", {}, ...rows));
  }

  private row(join: Join, index: number): HTMLElement {
    const { id } = this.state.scene;
    const isChosen = id.kind === "join" && id.join === index;
    const button = h("button", {
      type: "button", class: "link", title: joinTitle(this.state, join), "aria-pressed": String(isChosen), "data-join": index,
      "aria-label": `Show ${joinTitle(this.state, join)}`, click: () => {
        this.choose(index);
        this.focusRow(index, false);
      },
    }, badge(this.state, join.fixed), " – ", badge(this.state, join.moving));
    return h("tr", { class: isChosen ? "chosen" : "" },
      h("td", {}, button),
      h("td", { class: `outcome ${join.outcome}` }, join.outcome),
      h("td", { class: "number" }, probability(join.probability)),
      h("td", { class: "number" }, fixed(join.acceptance_index, 3)),
      h("td", { class: "number" }, percent(join.overlap)));
  }

  private showChosen(): void {
    const { id } = this.state.scene;
    if (id.kind !== "join") {
      replace(this.chosen, h("p", { class: "soft" },
        `${count(this.state.report.joins.length, "comparison")}. Choose one to see just its two maps, and the other ways in which they may lie.`));
      return;
    }
    const join = this.state.report.joins[id.join];
    replace(this.chosen,
      h("h3", {}, mapLabel(this.state, join.fixed), h("span", { class: "soft" }, " and "), mapLabel(this.state, join.moving)),
      h("p", {}, h("strong", { class: `outcome ${join.outcome}` }, join.outcome), `: ${outcomeMeaning[join.outcome]}`,
        join.reason ? ` (${reasons[join.reason] ?? join.reason})` : null, "."),
      figures(join, id.hypothesis), this.hypotheses(join, id.join, id.hypothesis),
      h("div", { class: "buttons" },
        h("button", { type: "button", class: "back", click: () => this.goBack(id.join) }, "Back to the whole"),
        h("button", {
          type: "button", class: "adopt", title: "Take the second map in hand, as it lies here, to save its pose for the next merge",
          click: () => this.placeByHand(join.moving, join.fixed, this.state.poseOf(join.moving)!),
        }, "Place it so by hand")));
  }

  private hypotheses(join: Join, index: number, current: number): HTMLElement | null {
    if (join.hypotheses.length === 0) return null;
    const merged = mergedHypothesis(join);
    const option = (hypothesis: number, ...label: (string | HTMLElement)[]) => {
      const radio = h("input", {
        type: "radio", name: "hypothesis", value: hypothesis, change: () => {
          this.choose(index, hypothesis);
          this.chosen.querySelector<HTMLInputElement>(`input[value="${hypothesis}"]`)?.focus();
        },
      });
      radio.checked = hypothesis === current;
      return h("label", { class: "hypothesis" }, radio, h("span", {}, ...label));
    };
    return h("fieldset", { class: "hypotheses" },
      h("legend", {}, "Ways in which they may lie"),
      merged >= 0 || !isUsed(join) ? null
        : option(-1, h("strong", {}, "as merged"), h("br"), h("span", { class: "soft" }, describe(join.transform))),
      ...join.hypotheses.map((hypothesis, i) => option(i,
        `${i + 1}: probability ${probability(hypothesis.probability)}, score ${fixed(hypothesis.score, 0)} nats`,
        i === merged && isUsed(join) ? h("strong", {}, " (as merged)") : "",
        h("br"), h("span", { class: "soft" }, describe(hypothesis.transform)))));
  }
}

/** The hypothesis that the merge uses, or would use; -1 if it is none of them. */
function mergedHypothesis(join: Join): number {
  const same = JSON.stringify(join.transform);
  return join.hypotheses.findIndex((hypothesis) => JSON.stringify(hypothesis.transform) === same);
}

/** The engine counts cells for the best hypothesis alone. */
function figures(join: Join, shown: number): HTMLElement {
  const pairs: [string, string][] = [
    ["Probability", probability(shown < 0 ? join.probability : join.hypotheses[shown].probability)],
    ["Acceptance index", fixed(join.acceptance_index, 4)],
    ["Cells that agree", String(join.agreement)],
    ["Cells that do not", String(join.disagreement)],
    ["Overlap", percent(join.overlap)],
  ];
  const list = h("dl", { class: "figures" }, ...pairs.flatMap(([term, value]) => [h("dt", {}, term), h("dd", {}, value)]));
  const isOfBest = shown === 0 || join.hypotheses.length === 0;
  return h("div", {}, list, isOfBest ? null : h("p", { class: "soft" }, "Index, cells and overlap are those of the first hypothesis."));
}
