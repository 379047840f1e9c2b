// SPDX-License-Identifier: Apache-2.0
import { h, replace } from "./dom";
import { percent } from "./numbers";
import type { Score } from "./score";
import type { Yardstick } from "./yardstick";

/** How well the map in hand fits: its walls met as a bar, and what that may be held against. */
export class Gauge {
  readonly element = h("div", { class: "gauge" });
  private readonly line = h("p", { class: "score", id: "hand-score" });
  private readonly bar = h("div", { class: "gauge-bar", "aria-hidden": "true" });
  private readonly fill = h("div", { class: "gauge-fill" });
  private readonly band = h("div", { class: "gauge-band" });
  private readonly tick = h("div", { class: "gauge-tick" });
  private readonly meaning = h("p", { class: "soft", id: "hand-yardstick" });

  constructor() {
    replace(this.bar, this.band, this.fill, this.tick);
    replace(this.element, this.line, this.bar, this.meaning);
    this.hold(null);
  }

  /** Null: the map has nothing in common with the others here. */
  show(score: Score | null): void {
    this.line.textContent = score
      ? `Walls met ${percent(score.wallsMet)} · cells equal ${percent(score.agreement)} · overlap ${percent(score.overlap)}`
      : "Nothing in common with the other maps here.";
    this.fill.style.width = `${100 * (score?.wallsMet ?? 0)}%`;
  }

  /** What a good figure is; null while it is worked out. */
  hold(yardstick: Yardstick | null): void {
    this.band.hidden = this.tick.hidden = yardstick === null;
    if (!yardstick) {
      this.meaning.textContent = "";
      return;
    }
    const { joined, chance } = yardstick;
    this.tick.hidden = chance === null;
    this.tick.style.left = `${100 * (chance ?? 0)}%`;
    this.band.hidden = joined === null;
    if (joined) {
      this.band.style.left = `${100 * joined.least}%`;
      this.band.style.width = `${100 * (joined.most - joined.least)}%`;
    }
    this.meaning.textContent = (joined
      ? `Walls met is the figure that counts: the maps that were joined have ${range(joined.least, joined.most)} (the band). `
      : "Walls met is the figure that counts. ") +
      (chance === null
        ? "The others have seen too little to tell what this map has by chance."
        : `Where the others have seen much of it, this map has up to ${percent(chance)} by chance (the mark): a good place is far above that.`);
  }
}

function range(least: number, most: number): string {
  return percent(least) === percent(most) ? percent(least) : `${percent(least)} to ${percent(most)}`;
}
