// SPDX-License-Identifier: Apache-2.0
import { mapLabel } from "./badge";
import { announce, copyButton, download } from "./clipboard";
import { h, replace, say } from "./dom";
import { asInitialPoses, commandWith } from "./formats";
import { NumberField } from "./number_field";
import { radians } from "./numbers";
import type { State } from "./state";

const fileName = "poses.tsv";
/** How well the poses of maps that were not moved are taken to be known, if the merge does not say; but never as less than `leastSd`. */
const keptSd = { position: 0.1, theta: 0.01 };
const leastSd = { position: 0.02, theta: 0.002 };
/** Of those that were, in metres and degrees, unless the user knows better. */
const handSd = { position: 0.3, degrees: 2 };

/** Poses that were given by hand, as a table for the next merge, and the command that takes it. */
export class Saving {
  readonly element = h("div", { class: "saving" });
  private readonly state: State;
  /** What is wrong with the pose that is typed. */
  private readonly poseProblem: () => string | null;
  private readonly sd = new NumberField({
    id: "hand-sd", what: "the deviation of positions", label: "Standard deviation of the positions, in metres", least: 0.001, most: 100000,
    step: 0.1, note: "hand-reason", isKept: true, typed: () => this.judge(),
  });
  private readonly sdTheta = new NumberField({
    id: "hand-sd-theta", what: "the deviation of directions", label: "Standard deviation of the directions, in degrees", least: 0.01, most: 360,
    step: 0.5, note: "hand-reason", isKept: true, typed: () => this.judge(),
  });
  private readonly reason = h("p", { class: "invalid", id: "hand-reason", role: "status" });
  private buttons: HTMLButtonElement[] = [];
  private readonly deviations = h("p", {}, "Known to within ", this.sd.element, " m and ", this.sdTheta.element, " °");
  private maps: string | null = null;

  constructor(state: State, poseProblem: () => string | null) {
    this.state = state;
    this.poseProblem = poseProblem;
    this.sd.show(String(handSd.position));
    this.sdTheta.show(String(handSd.degrees));
  }

  update(): void {
    const moved = [...this.state.byHand().keys()];
    if (this.maps !== moved.join(" ")) {
      this.maps = moved.join(" ");
      this.rebuild(moved);
    }
    this.judge();
  }

  private rebuild(moved: number[]): void {
    // The fields stay where nothing is placed: the page that is loaded next finds what they hold.
    this.element.hidden = moved.length === 0;
    const { report } = this.state;
    const command = commandWith(report, fileName);
    const save = h("button", { type: "button", id: "hand-save", class: "primary", click: () => this.save() }, `Save ${fileName}`);
    const copy = command === null ? null : copyButton("Copy command", () => command, "Copy command that merges with the poses");
    this.buttons = copy ? [save, copy] : [save];
    replace(this.element,
      h("h3", {}, "Placed by hand"),
      h("ul", {}, ...moved.map((map) => h("li", {}, mapLabel(this.state, map)))),
      this.deviations,
      this.reason,
      h("div", { class: "buttons" }, save),
      command === null
        ? h("p", { class: "soft" }, "The maps' names hold characters that a table of poses cannot: rename the files first.")
        : h("div", {}, h("p", { class: "soft" }, report.answer === undefined
          ? "Then, from the folder in which the maps were merged, with the file there too, and with the options of that merge if it had any:"
          : "Then end the node, and start it again with the file, and with the other options that it had:"),
        h("pre", {}, command), copy));
  }

  /** Nothing is saved that is not as the fields show it. */
  private judge(): void {
    const poseProblem = this.poseProblem();
    const problem = poseProblem ?? this.sd.problem ?? this.sdTheta.problem;
    // Screen readers hear of a wrong pose beside its fields.
    this.reason.setAttribute("aria-live", poseProblem === null ? "polite" : "off");
    say(this.reason, problem === null ? "" : `Not to be saved: ${problem}.`);
    for (const button of this.buttons) button.disabled = problem !== null;
  }

  private keptDeviation(map: number): { sd: number; sdTheta: number } {
    const { component } = this.state.scene;
    const members = component === null ? [] : this.state.report.components[component].members;
    const { position, theta } = members.find((member) => member.map === map)?.sd ?? keptSd;
    return { sd: Math.max(position, leastSd.position), sdTheta: Math.max(theta, leastSd.theta) };
  }

  private save(): void {
    const sd = this.sd.value;
    const degrees = this.sdTheta.value;
    if (sd === null || degrees === null) return;
    const byHand = this.state.byHand();
    const text = asInitialPoses(this.state.settled().map(({ map, T_scene_map }) => ({
      name: this.state.report.maps[map].name,
      transform: T_scene_map,
      ...(byHand.has(map) ? { sd, sdTheta: radians(degrees) } : this.keptDeviation(map)),
    })));
    if (text === null) {
      announce("Not saved: a map's name cannot be written in a table");
      return;
    }
    download(fileName, text);
    announce(`${fileName} saved`);
  }
}
