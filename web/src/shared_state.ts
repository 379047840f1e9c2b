// SPDX-License-Identifier: Apache-2.0
import { copy } from "./clipboard";
import { h } from "./dom";
import { type SharedView, defaultView, fromHash, isForeign, toHash } from "./link";
import type { Look, State } from "./state";
import type { Stage } from "./stage";
import type { Tabs } from "./tabs";

/** Between what the page shows and links to it. */
export class SharedState {
  /** Says that a link does not fit. */
  readonly note = h("p", { class: "problem", id: "link-problem", role: "alert" });
  private readonly state: State;
  private readonly stage: Stage;
  private readonly tabs: Tabs;

  constructor(state: State, stage: Stage, tabs: Tabs) {
    this.state = state;
    this.stage = stage;
    this.tabs = tabs;
  }

  /** Puts the view into the address, and copies that; returns whether it could be copied. */
  async copyLink(): Promise<boolean> {
    const hash = toHash(this.view(), this.state.report);
    const link = location.href.replace(/#.*$/, "") + `#${hash}`;
    history.replaceState(null, "", link);
    return copy(link);
  }

  /** Shows what a link to a view was copied of. An empty hash is as the report was opened. */
  restore(hash: string): void {
    const { state } = this;
    const view = fromHash(hash, state.report, this.tabs.ids);
    this.note.textContent = isForeign(hash, state.report)
      ? "This link is to another merge. What it says of maps, and their poses, is left out." : "";
    this.show(view);
  }

  show(view: SharedView): void {
    const { state, stage } = this;
    state.show(view.scene);
    set(state.merged, view.merged);
    set(state.agreement, view.agreement);
    set(state.plan, view.plan);
    state.looks.forEach((look, map) => {
      set(look, view.maps.get(map) ?? 1);
      look.color = view.colors.get(map) ?? state.report.maps[map].color;
    });
    for (const topic of ["looks", "colors"] as const) state.changed(topic);
    // Those that were placed before stay: they are somebody's work.
    for (const [map, pose] of view.placed) state.put(map, pose);
    this.tabs.select(this.tabs.ids.includes(view.tab) ? view.tab : defaultView(state.report).tab);
    stage.showGrid(view.grid);
    state.setBent(view.bent);
    state.showArrows(view.arrows);
    stage.lookAt(view.center && { center: view.center, metres: view.metres });
    state.measure(view.ruler && { ...view.ruler, open: false });
  }

  view(): SharedView {
    const { state, stage } = this;
    const { aim } = stage;
    const ruler = state.ruler;
    return {
      scene: state.scene.id,
      center: aim && aim.center,
      metres: aim ? aim.metres : 0,
      tab: this.tabs.selected,
      merged: strengthOf(state.merged),
      agreement: strengthOf(state.agreement),
      plan: strengthOf(state.plan),
      maps: new Map(state.looks.map((look, map) => [map, strengthOf(look)])),
      colors: new Map(state.looks.map(({ color }, map) => [map, color])),
      placed: state.byHand(),
      grid: stage.gridShown,
      bent: state.bent,
      arrows: state.arrows,
      ruler: ruler?.from && ruler.to ? { from: ruler.from, to: ruler.to } : null,
    };
  }
}

function strengthOf(look: Look): number {
  return look.visible ? look.opacity : 0;
}

/** What is hidden comes back in full. */
function set(look: Look, strength: number): void {
  look.visible = strength > 0;
  look.opacity = strength > 0 ? strength : 1;
}
