// SPDX-License-Identifier: Apache-2.0
import { h } from "./dom";

export interface NumberFieldOptions {
  id: string;
  /** What it is a number of, as sentences begin with it: "x". */
  what: string;
  /** For readers that see no text beside the field. */
  label?: string;
  least: number;
  most: number;
  step: number;
  /** Whether it is as it was when the page is loaded anew. */
  isKept?: boolean;
  /** The id of what says what is wrong with it. */
  note: string;
  /** Of each text that is typed, of numbers and of others. */
  typed(): void;
}

/** A field for a number within bounds. What is no such number stays in it, is marked, and counts for nothing. */
export class NumberField {
  readonly element: HTMLInputElement;
  private readonly options: NumberFieldOptions;
  private isTyped = false;

  constructor(options: NumberFieldOptions) {
    this.options = options;
    const { id, label, step, isKept = false } = options;
    this.element = h("input", {
      // No bounds: browsers count steps from the lower one.
      type: "number", id, step, "data-kept": isKept, ...(label === undefined ? {} : { "aria-label": label }),
      focus: () => (this.isTyped = false),
      blur: () => (this.isTyped = false),
      input: () => {
        this.isTyped = true;
        this.mark();
        options.typed();
      },
    });
  }

  /** Whether something was typed since it has the focus, which another text would take away. */
  get isBeingTyped(): boolean {
    return this.isTyped;
  }

  /** Null: there is none. */
  get value(): number | null {
    const { valueAsNumber } = this.element;
    return valueAsNumber >= this.options.least && valueAsNumber <= this.options.most ? valueAsNumber : null;
  }

  show(text: string): void {
    this.element.value = text;
    this.mark();
  }

  /** What is wrong with what it holds; null: nothing. */
  get problem(): string | null {
    const { what, least, most } = this.options;
    return this.value === null ? `${what} has to be a number from ${least} to ${most}` : null;
  }

  private mark(): void {
    const isWrong = this.value === null;
    this.element.setAttribute("aria-invalid", String(isWrong));
    if (isWrong) this.element.setAttribute("aria-describedby", this.options.note);
    else this.element.removeAttribute("aria-describedby");
  }
}
