// SPDX-License-Identifier: Apache-2.0
import { type KeptView, carriedOver, keptView, keysOf } from "./kept";
import type { Sorting } from "./join_table";
import type { SharedState } from "./shared_state";
import type { State } from "./state";

/** What only parts of the page know. */
export interface Parts {
  shared: SharedState;
  /** Takes a map in hand. */
  take(map: number): void;
  /** The list of joins. */
  sorting: Sorting;
  /** Of a page that follows a node: whether it stays with its answer. */
  paused: boolean;
}

interface Memory {
  view: KeptView;
  inHand: string | null;
  query: string;
  sorting: Sorting;
  paused: boolean;
  /** By id: what fields hold, and how far panels are scrolled. */
  fields: [string, string | boolean][];
  scrolled: [string, number][];
  focus: string;
}

const keptFields = () => document.querySelectorAll<HTMLInputElement>("input[data-kept]");

/** Hands the reader's work to the page that is loaded next, from the same address in the same tab. */
export class PageMemory {
  private readonly state: State;
  private readonly parts: Parts;
  /** Where pages of this address, in this tab, leave what their reader has done; those of another program mean something else. */
  private readonly place: string;

  constructor(state: State, parts: Parts) {
    this.state = state;
    this.parts = parts;
    this.place = `gridmerge ${state.report.version} ${location.pathname}`;
    addEventListener("pagehide", () => this.keep());
  }

  private keep(): void {
    const { state, parts } = this;
    const { report, handled } = state;
    const memory: Memory = {
      view: keptView(report, parts.shared.view(), state.allByHand()),
      inHand: handled === null ? null : keysOf(report)[handled],
      query: state.query,
      sorting: parts.sorting,
      paused: parts.paused,
      fields: [...keptFields()].map((field) => [field.id, field.type === "checkbox" ? field.checked : field.value]),
      scrolled: [...document.querySelectorAll(".panel")].map((panel) => [panel.id, panel.scrollTop]),
      focus: document.activeElement?.id ?? "",
    };
    try {
      sessionStorage.setItem(this.place, JSON.stringify(memory));
    } catch {
      // A browser may let pages keep nothing.
    }
  }

  /** Whether the page was loaded anew, and there is something to show as it was. */
  restore(): boolean {
    const { state, parts } = this;
    const memory = isReloaded() ? this.read() : null;
    // A node's next answer is of the same robots. Elsewhere another merge is another matter.
    if (!memory || (memory.view.merge !== state.report.merge && state.report.answer === undefined)) return false;
    const { view, hand } = carriedOver(state.report, memory.view);
    state.layByHand(hand);
    parts.shared.show(view);
    state.search(memory.query);
    parts.sorting = memory.sorting;
    parts.paused = memory.paused;
    const inHand = memory.inHand === null ? -1 : keysOf(state.report).indexOf(memory.inHand);
    if (inHand >= 0) parts.take(inHand);
    // Panels may be filled in the next frame only.
    requestAnimationFrame(() => restoreFields(memory));
    return true;
  }

  private read(): Memory | null {
    try {
      return JSON.parse(sessionStorage.getItem(this.place) ?? "null") as Memory | null;
    } catch {
      return null;
    }
  }
}

function isReloaded(): boolean {
  const [navigation] = performance.getEntriesByType("navigation") as PerformanceNavigationTiming[];
  return ["reload", "back_forward"].includes(navigation?.type);
}

function restoreFields({ fields, scrolled, focus }: Memory): void {
  const held = new Map(fields);
  for (const field of keptFields()) {
    const value = held.get(field.id);
    if (typeof value === "boolean") field.checked = value;
    else if (value !== undefined) field.value = value;
    for (const type of ["input", "change"]) field.dispatchEvent(new Event(type));
  }
  document.getElementById(focus)?.focus({ preventScroll: true });
  for (const [id, top] of scrolled) document.getElementById(id)?.scrollTo({ top });
}
