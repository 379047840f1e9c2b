// SPDX-License-Identifier: Apache-2.0
import { isUnfinished } from "./ruler";
import type { State } from "./state";

/** So long after the last key or press nobody works a box, a slider or a list any more, though it has the focus [ms]. */
const rest = 10000;

const worked = "input:focus-visible, select:focus";
const begun = "dialog[open], input:active, input[type=color]:focus, input[type=number]:focus, input[type=text]:focus, input[type=search]:focus";

/** Makes the question whether the reader is at something that a new page would end. */
export function watchReader(state: State, canvas: HTMLElement): () => boolean {
  let last = -Infinity;
  for (const type of ["keydown", "pointerdown"]) addEventListener(type, () => (last = performance.now()), { capture: true });
  const has = (selector: string) => document.querySelector(selector) !== null;
  // The reader is at work on:
  return () => state.handled !== null // a map in hand
    || state.scene.id.kind === "join" // a join, which may be no more in the next answer
    || (state.ruler !== null && isUnfinished(state.ruler)) // a measurement
    || canvas.classList.contains("grabbing") // what is dragged
    || getSelection()?.isCollapsed === false // a text that is selected
    || has(begun) // a dialogue, or a field that is filled in
    || (has(worked) && performance.now() - last < rest); // a box, a slider or a list
}
