// SPDX-License-Identifier: Apache-2.0
import { h, replace } from "./dom";

/** Between questions to the node [ms]; a page is looked at for so long at least. */
const pause = 1500;

/** A node that does not answer for so long is taken for ended [ms]. */
const patience = 5000;

/** The newest answer's number, of the node that serves the page. */
async function ask(): Promise<number> {
  const response = await fetch("news", { cache: "no-store", signal: AbortSignal.timeout(patience) });
  const { answer } = await response.json() as { answer: unknown };
  if (!response.ok || typeof answer !== "number") throw new Error("no answer");
  return answer;
}

/**
 * Loads the page anew when the node that serves it has another answer than `shown`. Where the reader is at work, or has said that
 * the page is to stay, it says that there is one.
 */
export class Following {
  readonly element: HTMLElement;
  private readonly shown: number;
  /** The reader is at something that a new page would end. */
  private readonly isBusy: () => boolean;
  private readonly text = h("span", { role: "status" });
  private readonly load = h("button", { type: "button", id: "load-newest", hidden: true, click: () => location.reload() }, "Show it");
  private readonly pauseButton = h("button", { type: "button", id: "pause", click: () => this.pause(!this.isPaused) });
  private news: "none" | "newer" | "ended" = "none";
  private isPaused = false;

  constructor(shown: number, isBusy: () => boolean) {
    this.shown = shown;
    this.isBusy = isBusy;
    this.element = h("p", { id: "following" }, this.text, this.load, this.pauseButton);
    this.say();
    setTimeout(() => void this.look(), pause);
  }

  get paused(): boolean {
    return this.isPaused;
  }

  pause(isPaused: boolean): void {
    this.isPaused = isPaused;
    this.say();
  }

  private async look(): Promise<void> {
    // Where nobody looks there is nothing to follow.
    if (!document.hidden) {
      try {
        this.news = await ask() === this.shown ? "none" : "newer";
        if (this.news === "newer" && !this.isPaused && !this.isBusy()) return location.reload();
      } catch {
        this.news = "ended";
      }
      this.say();
    }
    setTimeout(() => void this.look(), pause);
  }

  private say(): void {
    const { shown, news, isPaused } = this;
    const state = news === "none" ? (isPaused ? "paused" : "live") : news;
    this.load.hidden = news !== "newer";
    this.pauseButton.textContent = isPaused ? "Follow" : "Pause";
    this.pauseButton.title = isPaused ? "Show newer answers as they come" : "Stay with this answer";
    if (this.element.dataset.state === state) return; // what is said once is not said again
    this.element.dataset.state = state;
    replace(this.text, {
      live: `Live: answer ${shown}`,
      paused: `Answer ${shown}, paused`,
      newer: `Answer ${shown}; a newer one is there. `,
      ended: `The node does not answer: this is its answer ${shown}`,
    }[state]);
  }
}
