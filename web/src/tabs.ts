// SPDX-License-Identifier: Apache-2.0
import { h } from "./dom";

export interface Tab {
  id: string;
  label: string;
  panel: HTMLElement;
}

/** Panels of which one is shown, as the ARIA pattern for tabs has it: arrows go from tab to tab. */
export class Tabs {
  readonly element: HTMLElement;
  private readonly tabs: Tab[];
  private readonly buttons: HTMLButtonElement[];
  private readonly onSelect: (id: string) => void;

  constructor(tabs: Tab[], onSelect: (id: string) => void) {
    this.tabs = tabs;
    this.onSelect = onSelect;
    this.buttons = tabs.map((tab, i) => h("button", {
      type: "button", role: "tab", id: `tab-${tab.id}`, "aria-controls": tab.panel.id,
      click: () => this.select(tab.id), keydown: (event) => this.key(event as KeyboardEvent, i),
    }, tab.label));
    for (const tab of tabs) {
      tab.panel.setAttribute("role", "tabpanel");
      tab.panel.setAttribute("aria-labelledby", `tab-${tab.id}`);
    }
    this.element = h("div", { class: "tabs" },
      h("div", { role: "tablist", class: "tablist" }, ...this.buttons), ...tabs.map((tab) => tab.panel));
    this.select(tabs[0].id);
  }

  get ids(): string[] {
    return this.tabs.map((tab) => tab.id);
  }

  get selected(): string {
    return this.tabs.find((tab) => !tab.panel.hidden)!.id;
  }

  select(id: string): void {
    this.tabs.forEach((tab, i) => {
      const selected = tab.id === id;
      tab.panel.hidden = !selected;
      this.buttons[i].setAttribute("aria-selected", String(selected));
      this.buttons[i].tabIndex = selected ? 0 : -1;
    });
    this.onSelect(id);
  }

  private key(event: KeyboardEvent, index: number): void {
    const step = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (step === 0) return;
    event.preventDefault();
    const next = (index + step + this.tabs.length) % this.tabs.length;
    this.select(this.tabs[next].id);
    this.buttons[next].focus();
  }
}
