// SPDX-License-Identifier: Apache-2.0
import { type KeptView, carriedOver, keptView, keysOf } from "./kept";
import type { Sorting } from "./join_table";
import { toHash } from "./link";
import type { SharedState } from "./shared_state";
import type { Look, State } from "./state";

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

/** What has the focus; in the row of a map, whose number ends its id, without that number. */
interface KeptFocus {
  id: string;
  map: string | null;
  /** By keyboard, or in a field for text. */
  isVisible: boolean;
}

interface Memory {
  view: KeptView;
  /** How layers are drawn, those too that are hidden: the merge's own, and by map. */
  looks: { own: Look[]; maps: [string, Look][] };
  inHand: string | null;
  query: string;
  sorting: Sorting;
  paused: boolean;
  /** By id: what fields hold, and how far panels are scrolled. */
  fields: [string, string | boolean][];
  scrolled: [string, number][];
  focus: KeptFocus;
}

const plain = ({ visible, opacity }: Look): Look => ({ visible, opacity });

const ownLooks = ({ merged, agreement, plan }: State): Look[] => [merged, agreement, plan];

const keptFields = () => document.querySelectorAll<HTMLInputElement>("input[data-kept]");

/** Hands the reader's work to the page that is loaded next, from the same address in the same tab. */
export class PageMemory {
  private readonly state: State;
  private readonly parts: Parts;
  /** Where pages of this address, in this tab, leave what their reader has done; those of another program mean something else. */
  private readonly place: string;
  /** What was read is not all shown yet. */
  private isRestoring = false;

  constructor(state: State, parts: Parts) {
    this.state = state;
    this.parts = parts;
    this.place = `gridmerge ${state.report.version} ${location.pathname}`;
    addEventListener("pagehide", () => this.keep());
  }

  /** Whether a page that is loaded now loses nothing: what the reader has done is kept, or is nothing. */
  isSafe(): boolean {
    const { state, parts } = this;
    return this.keep() || (state.allByHand().length === 0 && toHash(parts.shared.view(), state.report) === "");
  }

  /** Whether the browser keeps it. */
  private keep(): boolean {
    // The fields do not hold yet what is kept already.
    if (this.isRestoring) return true;
    const { state, parts } = this;
    const { report, handled } = state;
    const keys = keysOf(report);
    const memory: Memory = {
      view: keptView(report, parts.shared.view(), state.allByHand()),
      looks: { own: ownLooks(state).map(plain), maps: state.looks.map((look, map) => [keys[map], plain(look)]) },
      inHand: handled === null ? null : keys[handled],
      query: state.query,
      sorting: parts.sorting,
      paused: parts.paused,
      fields: [...keptFields()].map((field) => [field.id, field.type === "checkbox" ? field.checked : field.value]),
      scrolled: [...document.querySelectorAll(".panel")].map((panel) => [panel.id, panel.scrollTop]),
      focus: keptFocus(keys),
    };
    try {
      sessionStorage.setItem(this.place, JSON.stringify(memory));
      return true;
    } catch {
      // A browser may let pages keep nothing, or no more. What they kept before is not what the reader has done.
      this.forget();
      return false;
    }
  }

  /** Whether the page was loaded anew, and there is something to show as it was. */
  restore(): boolean {
    try {
      const memory = isReloaded() ? this.read() : null;
      return memory !== null && this.lay(memory);
    } catch {
      // Something else wrote it.
      this.forget();
      return false;
    }
  }

  private lay(memory: Memory): boolean {
    const { state, parts } = this;
    // A node's next answer is of the same robots. Elsewhere another merge is another matter.
    if (memory.view.merge !== state.report.merge && state.report.answer === undefined) return false;
    const keys = keysOf(state.report);
    const { view, hand } = carriedOver(state.report, memory.view);
    state.layByHand(hand);
    parts.shared.show(view);
    ownLooks(state).forEach((look, i) => Object.assign(look, memory.looks.own[i]));
    const looks = new Map(memory.looks.maps);
    state.looks.forEach((look, map) => Object.assign(look, looks.get(keys[map])));
    state.changed("looks");
    state.search(memory.query);
    parts.sorting = memory.sorting;
    parts.paused = memory.paused;
    const inHand = memory.inHand === null ? -1 : keys.indexOf(memory.inHand);
    if (inHand >= 0) parts.take(inHand);
    // Panels may be filled in the next frame only.
    this.isRestoring = true;
    requestAnimationFrame(() => {
      this.isRestoring = false;
      restoreFields(memory, keys);
    });
    return true;
  }

  private read(): Memory | null {
    return JSON.parse(sessionStorage.getItem(this.place) ?? "null") as Memory | null;
  }

  private forget(): void {
    try {
      sessionStorage.removeItem(this.place);
    } catch {
      // Nor has it anything to remove then.
    }
  }
}

function isReloaded(): boolean {
  const [navigation] = performance.getEntriesByType("navigation") as PerformanceNavigationTiming[];
  return ["reload", "back_forward"].includes(navigation?.type);
}

function keptFocus(keys: string[]): KeptFocus {
  const element = document.activeElement;
  const id = element?.id ?? "";
  const map = element?.closest<HTMLElement>(".layer[data-map]")?.dataset.map;
  const isVisible = element?.matches(":focus-visible") ?? false;
  return map === undefined ? { id, map: null, isVisible } : { id: id.slice(0, -map.length), map: keys[Number(map)], isVisible };
}

/** Gives the focus back. Fields and lists that were only clicked do without: by script it comes as by keyboard. */
function restoreFocus({ id, map, isVisible }: KeptFocus, keys: string[]): void {
  const element = document.getElementById(map === null ? id : `${id}${keys.indexOf(map)}`);
  if (element && (isVisible || !element.matches("input, select"))) element.focus({ preventScroll: true });
}

function restoreFields({ fields, scrolled, focus }: Memory, keys: string[]): void {
  const held = new Map(fields);
  for (const field of keptFields()) {
    const value = held.get(field.id);
    if (value === undefined || value === (typeof value === "boolean" ? field.checked : field.value)) continue;
    if (typeof value === "boolean") field.checked = value;
    else field.value = value;
    for (const type of ["input", "change"]) field.dispatchEvent(new Event(type));
  }
  restoreFocus(focus, keys);
  for (const [id, top] of scrolled) document.getElementById(id)?.scrollTo({ top });
}
