// SPDX-License-Identifier: Apache-2.0
import { h, replace } from "./dom";

/** Between questions to the node [ms]; a page is looked at for so long at least. */
const pause = 1500;

/** A node that does not answer for so long is taken for ended [ms]. */
const patience = 5000;

/** What a page that follows has to know of what its reader does. */
export interface Follower {
  /** The reader is at something that a new page would end. */
  isBusy(): boolean;
  /** Puts the view into the address, so that the next page shows it too. */
  keepView(): void;
}

/** The newest answer's number, of the node that serves the page. */
async function ask(): Promise<number> {
  const response = await fetch("news", { cache: "no-store", signal: AbortSignal.timeout(patience) });
  const { answer } = await response.json() as { answer: unknown };
  if (!response.ok || typeof answer !== "number") throw new Error("no answer");
  return answer;
}

/**
 * Loads the page anew when the node that serves it has another answer than `shown`, with the view that the reader has chosen.
 * Where the reader is at work, it says that there is one.
 */
export function follow(shown: number, follower: Follower): HTMLElement {
  const text = h("span", {});
  const element = h("p", { id: "following", role: "status" }, text);
  const load = () => {
    follower.keepView();
    location.reload();
  };
  const button = h("button", { type: "button", id: "load-newest", click: load }, "Show it");
  const say = (state: "live" | "newer" | "ended") => {
    if (element.dataset.state === state) return; // what is said once is not said again
    element.dataset.state = state;
    replace(text, {
      live: `Live: answer ${shown}`,
      newer: `Answer ${shown}; a newer one is there. `,
      ended: `The node does not answer: this is its answer ${shown}`,
    }[state]);
    if (state === "newer") text.append(button);
  };
  const look = async () => {
    // Where nobody looks there is nothing to follow.
    if (!document.hidden) {
      try {
        if (await ask() === shown) say("live");
        else if (follower.isBusy()) say("newer");
        else return load();
      } catch {
        say("ended");
      }
    }
    setTimeout(() => void look(), pause);
  };
  say("live");
  setTimeout(() => void look(), pause);
  return element;
}
