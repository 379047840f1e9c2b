// SPDX-License-Identifier: Apache-2.0

/** "1 map", "2 maps". */
export function count(number: number, what: string): string {
  return `${number} ${what}${number === 1 ? "" : "s"}`;
}

/** A user's text for where elements cannot isolate it: without what would reorder or break the text around it. */
export function flat(text: string): string {
  return text.replace(/[\u0000-\u001f\u007f-\u009f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]/g, "\ufffd");
}

/** Names without the folders that all of them lie in: enough to tell the maps apart. */
export function shortNames(names: string[]): string[] {
  const folders = names.map((name) => name.split("/").slice(0, -1));
  const [first = []] = folders;
  const differs = first.findIndex((part, i) => !folders.every((folder) => folder[i] === part));
  const shared = differs < 0 ? first.length : differs;
  // Of the root alone nothing is dropped: its slash tells that the names are whole.
  const common = shared === 1 && first[0] === "" ? 0 : shared;
  return names.map((name) => name.split("/").slice(common).join("/"));
}
