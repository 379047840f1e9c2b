// SPDX-License-Identifier: Apache-2.0
import { badge } from "./badge";
import { h, replace } from "./dom";
import { joinTitle } from "./join_graph";
import { fixed, percent, probability } from "./numbers";
import { type Join, type Outcome, hasFigures, hasWay, isLarge, outcomes } from "./report";
import { moreNote, mostRows } from "./search";
import type { State } from "./state";

/** By which column, and whether its largest come first. */
export interface Sorting {
  column: number;
  isDescending: boolean;
}

interface Column {
  head: string;
  title: string;
  /** Smaller comes first while the column sorts upwards. */
  key(join: Join): number;
  /** Whether its largest come first when it is chosen. */
  isDescending: boolean;
}

const columns: readonly Column[] = [
  { head: "Maps", title: "number of the first map, then of the second", key: (join) => join.fixed * 1e6 + join.moving, isDescending: false },
  { head: "Outcome", title: "used ones first", key: (join) => outcomes.indexOf(join.outcome), isDescending: false },
  { head: "Probability", title: "of these two maps alone", key: (join) => join.probability, isDescending: true },
  { head: "Index", title: "acceptance index", key: (join) => join.acceptance_index, isDescending: true },
  { head: "Overlap", title: "share of the smaller map's known cells", key: (join) => join.overlap, isDescending: true },
];

/** The joins in rows, sorted by the column whose head was pressed last. */
export class JoinTable {
  readonly element = h("div", { class: "table" });
  private readonly state: State;
  private readonly shown: Set<Outcome>;
  private readonly choose: (join: number) => void;
  private sorting: Sorting = { column: 1, isDescending: false };

  constructor(state: State, shown: Set<Outcome>, choose: (join: number) => void) {
    this.state = state;
    this.shown = shown;
    this.choose = choose;
  }

  get sortedBy(): Sorting {
    return this.sorting;
  }

  sortBy(sorting: Sorting): void {
    this.sorting = sorting;
    this.update();
  }

  update(): void {
    const large = isLarge(this.state.report);
    const all = this.sorted();
    const rows = (large ? all.slice(0, mostRows) : all).map((index) => this.row(this.state.report.joins[index], index));
    if (rows.length === 0) {
      replace(this.element, h("p", { class: "soft" }, "No joins of these kinds."));
      return;
    }
    replace(this.element, h("table", {}, h("thead", {}, h("tr", {}, ...columns.map((_, i) => this.head(i)))), h("tbody", {}, ...rows)),
      moreNote(large ? all.length : 0, "join"));
  }

  /** The table may have been made anew, and the focus is lost with the old one. Returns whether the join is in it. */
  focus(join: number, scroll: boolean): boolean {
    const button = this.element.querySelector<HTMLElement>(`button[data-join="${join}"]`);
    button?.focus({ preventScroll: !scroll });
    return button !== null;
  }

  /** Ties are broken by probability. */
  private sorted(): number[] {
    const { joins } = this.state.report;
    const { column, isDescending } = this.sorting;
    const { key } = columns[column];
    const sign = isDescending ? -1 : 1;
    const isFound = ({ fixed: a, moving: b }: Join) => !isLarge(this.state.report) || this.state.isFound(a) || this.state.isFound(b);
    return [...joins.keys()].filter((index) => this.shown.has(joins[index].outcome) && isFound(joins[index])).sort((a, b) =>
      sign * (key(joins[a]) - key(joins[b])) || joins[b].probability - joins[a].probability || a - b);
  }

  private head(index: number): HTMLElement {
    const { head, title, isDescending } = columns[index];
    const { sorting } = this;
    const isSorted = sorting.column === index;
    const arrow = !isSorted ? "" : sorting.isDescending ? " ↓" : " ↑";
    return h("th", {
      class: index > 1 ? "number" : "", scope: "col", title,
      "aria-sort": !isSorted ? "none" : sorting.isDescending ? "descending" : "ascending",
    }, h("button", {
      type: "button", class: "sort", id: `sort-${index}`, "data-column": index, click: () => {
        this.sortBy({ column: index, isDescending: isSorted ? !sorting.isDescending : isDescending });
        this.element.querySelector<HTMLElement>(`button[data-column="${index}"]`)?.focus();
      },
    }, head, h("span", { "aria-hidden": "true" }, arrow)));
  }

  private row(join: Join, index: number): HTMLElement {
    const { id } = this.state.scene;
    const isChosen = id.kind === "join" && id.join === index;
    const title = joinTitle(this.state, join);
    const isTold = hasWay(join) && (!isLarge(this.state.report) || hasFigures(join));
    const button = h("button", {
      type: "button", class: "link", title, "aria-pressed": String(isChosen), "data-join": index, "aria-label": `${join.fixed + 1} – ${join.moving + 1}: show ${title}`,
      click: () => {
        this.choose(index);
        this.focus(index, false);
      },
    }, badge(this.state, join.fixed), " – ", badge(this.state, join.moving));
    return h("tr", { class: isChosen ? "chosen" : "" },
      h("td", {}, button),
      h("td", { class: `outcome ${join.outcome}` }, join.outcome),
      h("td", { class: "number" }, hasWay(join) ? probability(join.probability) : "–"),
      h("td", { class: "number" }, isTold ? fixed(join.acceptance_index, 3) : "–"),
      h("td", { class: "number" }, isTold ? percent(join.overlap) : "–"));
  }
}
