// SPDX-License-Identifier: Apache-2.0
import { h } from "./dom";
import type { State } from "./state";
import { count } from "./text";

/** So many rows are made of a list; a search brings the others. */
export const mostRows = 50;

/** A field that searches maps by their names; all such fields say the same. */
export function searchBox(state: State): HTMLElement {
  const field = h("input", {
    type: "search", placeholder: "Name or number", "aria-label": "Find maps by name or number", class: "search",
    input: () => state.search(field.value),
  });
  state.on("query", () => {
    if (field.value !== state.query) field.value = state.query;
  });
  return h("label", { class: "search-label" }, "Find ", field);
}

/** What is not listed of so many; null if all is. */
export function moreNote(all: number, what: string): HTMLElement | null {
  return all <= mostRows ? null : h("p", { class: "soft" }, `${mostRows} of ${count(all, what)}: search for others.`);
}
