// SPDX-License-Identifier: Apache-2.0
import { h } from "./dom";

/** Copies text; returns whether it could. Pages opened from a disk have no clipboard of their own in some browsers. */
export async function copy(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return copyBySelection(text);
  }
}

function copyBySelection(text: string): boolean {
  const area = h("textarea", { class: "offscreen", "aria-hidden": "true", tabindex: -1 });
  area.value = text;
  const focused = document.activeElement;
  document.body.append(area);
  area.select();
  const copied = document.execCommand("copy");
  area.remove();
  if (focused instanceof HTMLElement) focused.focus();
  return copied;
}

/** A button that copies what `text` gives when it is pressed, and says so. `hint`, "Copy …", has the label's words in it. */
export function copyButton(label: string, text: () => string, hint: string): HTMLButtonElement {
  const button = h("button", { type: "button", title: hint, "aria-label": hint, click: () => void press() }, label);
  async function press(): Promise<void> {
    const copied = await copy(text());
    button.textContent = copied ? "Copied" : "Not copied";
    announce(copied ? hint.replace(/^Copy/, "Copied") : "The browser did not let the page copy");
    setTimeout(() => (button.textContent = label), 1500);
  }
  return button;
}

/** Says something to screen readers. */
export function announce(text: string): void {
  const live = document.getElementById("announcements");
  if (!live) return;
  // The same text twice is news twice.
  live.textContent = "";
  requestAnimationFrame(() => (live.textContent = text));
}

/** Offers text, or data of any kind, as a file. */
export function download(fileName: string, content: string | Blob): void {
  const blob = typeof content === "string" ? new Blob([content], { type: "text/plain;charset=utf-8" }) : content;
  const url = URL.createObjectURL(blob);
  const link = h("a", { href: url, download: fileName });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}
