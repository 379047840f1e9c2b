// SPDX-License-Identifier: Apache-2.0
import { badge, mapLabel } from "./badge";
import { h, replace } from "./dom";
import { describe } from "./formats";
import { joinGraph, joinTitle } from "./join_graph";
import { fixed, percent, probability } from "./numbers";
import { type Join, type Outcome, count, outcomeMeaning, outcomes } from "./report";
import { firstScene } from "./scene";
import type { State } from "./state";

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

  constructor(state: State) {
    this.state = state;
    const all = state.report.joins.length <= crowded;
    this.shown = new Set(outcomes.filter((outcome) => all || outcome !== "refused"));
    if (state.report.joins.every((join) => !this.shown.has(join.outcome))) this.shown.add("refused");
    replace(this.element, this.chosen, this.filters(), this.graph, this.table);
    state.on("scene", () => this.update());
    state.on("looks", () => this.update());
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

  /** -1: as the merge has it, which need not be the best hypothesis of the two maps alone. */
  private choose(join: number, hypothesis = -1): void {
    this.state.show({ kind: "join", join, hypothesis });
    this.element.scrollTop = 0;
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
        this.table.querySelector<HTMLElement>(`button[data-join="${index}"]`)?.focus({ preventScroll: true });
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
      figures(join), this.hypotheses(join, id.join, id.hypothesis),
      h("button", {
        type: "button", class: "back", click: () => this.state.show(firstScene(this.state.report)),
      }, "Back to the whole"));
  }

  private hypotheses(join: Join, index: number, current: number): HTMLElement | null {
    if (join.hypotheses.length === 0) return null;
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
      option(-1, h("strong", {}, join.outcome === "refused" || join.outcome === "rejected" ? "best guess" : "as merged"),
        `, probability ${probability(join.probability)}`, h("br"), h("span", { class: "soft" }, describe(join.transform))),
      ...join.hypotheses.map((hypothesis, i) => option(i,
        `hypothesis ${i + 1}: score ${fixed(hypothesis.score, 0)}, probability ${probability(hypothesis.probability)}`,
        h("br"), h("span", { class: "soft" }, describe(hypothesis.transform)))));
  }
}

function figures(join: Join): HTMLElement {
  const pairs: [string, string][] = [
    ["Probability", probability(join.probability)],
    ["Acceptance index", fixed(join.acceptance_index, 4)],
    ["Cells that agree", String(join.agreement)],
    ["Cells that do not", String(join.disagreement)],
    ["Overlap", percent(join.overlap)],
  ];
  const list = h("dl", { class: "figures" }, ...pairs.flatMap(([term, value]) => [h("dt", {}, term), h("dd", {}, value)]));
  const [best] = join.hypotheses;
  // Counts are made for the best hypothesis; consistency may have chosen another one.
  const isBest = !best || JSON.stringify(best.transform) === JSON.stringify(join.transform);
  return h("div", {}, list, isBest ? null : h("p", { class: "soft" }, "Index, cells and overlap are those of hypothesis 1."));
}
