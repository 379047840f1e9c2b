// SPDX-License-Identifier: Apache-2.0
import { mapLabel } from "./badge";
import { h, replace, say } from "./dom";
import { refine } from "./engine";
import { Gauge } from "./gauge";
import type { Grid } from "./grid";
import { NumberField } from "./number_field";
import { degrees, fixed, probability, radians } from "./numbers";
import { type Place, placesOf } from "./places";
import { Saving } from "./saving";
import type { Placed } from "./scene";
import { Scorer } from "./score";
import { type SE2, farthest, normalizeAngle } from "./se2";
import type { State } from "./state";
import { flat } from "./text";
import { type Yardstick, laid, yardstickOf } from "./yardstick";

const longWait = 10000; // milliseconds
const mostTurned = 3600; // degrees: whole turns may have been counted
const yardstickBudget = 4; // milliseconds a frame

/** A field for a part of a pose. */
interface PoseInput {
  field: NumberField;
  get(pose: SE2): number;
}

/** Placing maps by hand: takes one, moves it, judges how it fits, and saves poses for the next merge. */
export class HandPanel {
  readonly element = h("div", { class: "panel", id: "panel-hand" });
  private readonly state: State;
  private readonly middleOfView: () => { x: number; y: number };
  private readonly picker = h("select", { id: "hand-map", change: () => this.pick() });
  private readonly tools = h("div");
  private readonly gauge = new Gauge();
  private readonly placeLine = h("p", { class: "soft", id: "hand-place" });
  private readonly answer = h("p", { class: "answer", role: "status" });
  private readonly saving: Saving;
  private readonly poseNote = h("p", { class: "invalid", id: "hand-pose-note", role: "status" });
  private inputs: PoseInput[] = [];
  private toolsOf: number | null = null;
  private scorers = new Map<number, Scorer>();
  private scoring = 0;
  /** What the score is held against, as far as it is worked out, and for which maps and places. */
  private yardstick: Generator<undefined, Yardstick> | null = null;
  private yardstickOf = "";
  /** Where comparisons have the map in hand, and which of them it was laid at; -1: none. */
  private places: Place[] = [];
  private place = -1;
  /** While the engine is at work on a pose. */
  private asking: AbortController | null = null;
  /** Of which places of the maps the answer tells. */
  private saidOf = "";

  constructor(state: State, middleOfView: () => { x: number; y: number }) {
    this.state = state;
    this.middleOfView = middleOfView;
    this.saving = new Saving(state, () => this.poseProblem());
    replace(this.element,
      h("p", { class: "soft" },
        "Put a map where you know it belongs, save the poses, and merge again with them. Nothing here changes the merged map itself."),
      h("label", { class: "field" }, "Map in hand ", this.picker), this.tools, this.saving.element);
    state.on("scene", () => this.rebuild());
    state.on("hand", () => this.update());
    for (const topic of ["grids", "bend"] as const) state.on(topic, () => this.score());
    this.rebuild();
  }

  /** Takes a map in hand; one that is not in the scene comes to where its best comparison has it. */
  take(map: number): void {
    // A map that was offered and not placed is no company.
    if (this.state.handled !== null && this.state.handled !== map) this.state.letGo();
    const middle = this.state.grids[map]?.middle() ?? { x: 0, y: 0 };
    const to = this.middleOfView();
    this.places = placesOf(this.state.report, map, middle, this.others(map));
    this.place = this.state.poseOf(map) ? -1 : 0;
    this.state.take(map, this.places[0]?.T_scene_map ?? { x: to.x - middle.x, y: to.y - middle.y, theta: 0 });
  }

  /** Lays the map in hand where another comparison, or another way of the same one, has it. */
  private toNextPlace(): void {
    const { handled } = this.state;
    if (handled === null || this.places.length === 0) return;
    this.place = (this.place + 1) % this.places.length;
    this.state.put(handled, this.places[this.place].T_scene_map);
  }

  /** Which of the places the map in hand lies at, if it has not been moved from there. */
  private tellPlace(map: number | null, pose: SE2 | null): void {
    const place = this.places[this.place];
    const isThere = pose !== null && JSON.stringify(pose) === JSON.stringify(place?.T_scene_map);
    const isNew = map !== null && !this.state.byHand().has(map) && !this.state.scene.placed.some((placed) => placed.map === map);
    if (isThere) {
      replace(this.placeLine, `Place ${this.place + 1} of ${this.places.length} that comparisons found: with `,
        mapLabel(this.state, place.with), `, probability ${probability(place.probability)}.`);
    } else {
      replace(this.placeLine, isNew && !place ? "No comparison says where it may lie: it starts in the middle of the view." : null);
    }
  }

  /** Asks the engine to climb from where the map in hand lies. */
  async refine(): Promise<void> {
    const { state } = this;
    const inHand = state.inHand();
    if (!inHand || this.asking) return;
    const { map, pose } = inHand;
    if (!state.report.live) {
      this.say("Only a running gridmerge can refine: open the folder with gridmerge view.");
      return;
    }
    const asking = this.asking = new AbortController();
    this.say("Refining…");
    const timer = setTimeout(() => this.say("Refining… gridmerge takes long to answer. Move a map to stop waiting."), longWait);
    try {
      const refined = await refine({ merge: state.report.merge, moving: map, pose, fixed: this.others(map) }, asking);
      if (this.asking !== asking) return;
      this.asking = null;
      state.put(map, refined.transform);
      this.say(`Moved by ${fixed(refined.moved, 2)} m. Score ${fixed(refined.start_score, 0)} → ` +
        `${fixed(refined.score, 0)}. Probability by the maps alone ${probability(refined.probability)}.`);
    } catch (error) {
      // Who has moved a map since may ask for another pose already.
      if (this.asking !== asking) return;
      this.asking = null;
      this.say(`Not refined: ${error instanceof Error ? error.message : String(error)}`);
    } finally {
      clearTimeout(timer);
    }
  }

  /** What the engine is asked about: the map in hand, and where it and the others lie. */
  private situation(): string {
    return JSON.stringify([this.state.scene.id, this.state.handled, this.state.placed()]);
  }

  /** Says something of where the maps lie now. */
  private say(text: string): void {
    this.answer.textContent = text;
    this.saidOf = this.situation();
  }

  /** What was said of other places, or is asked about them, says nothing of these. */
  private dropAnswer(): void {
    if (this.answer.textContent === "" || this.saidOf === this.situation()) return;
    this.asking?.abort();
    this.asking = null;
    this.say("");
  }

  private others(map: number): Placed[] {
    return this.state.placed().filter((placed) => placed.map !== map);
  }

  private pick(): void {
    const map = Number(this.picker.value);
    if (this.picker.value === "") this.state.letGo();
    else this.take(map);
  }

  private rebuild(): void {
    replace(this.picker, h("option", { value: "" }, "none"), ...this.state.names.map(
      (name, i) => h("option", { value: i }, `${i + 1}: ${flat(name)}`)));
    this.rebuildTools();
    this.update();
  }

  private update(): void {
    const { handled } = this.state;
    this.picker.value = handled === null ? "" : String(handled);
    if (handled !== this.toolsOf) this.rebuildTools();
    const pose = handled === null ? null : this.state.poseOf(handled);
    for (const { field, get } of this.inputs) {
      if (pose && !field.isBeingTyped) field.show(fixed(get(pose), 3));
    }
    this.tellPose();
    this.tellPlace(handled, pose);
    this.dropAnswer();
    if (this.scoring === 0) this.scoring = requestAnimationFrame(() => this.score());
    this.saving.update();
  }

  private rebuildTools(): void {
    const map = this.toolsOf = this.state.handled;
    this.inputs = [];
    if (map === null) {
      replace(this.tools);
      return;
    }
    this.inputs = [
      this.poseInput("x", farthest, 0.05, (pose) => pose.x, (pose, x) => ({ ...pose, x })),
      this.poseInput("y", farthest, 0.05, (pose) => pose.y, (pose, y) => ({ ...pose, y })),
      this.poseInput("theta", mostTurned, 1, (pose) => degrees(pose.theta), (pose, value) => ({ ...pose, theta: normalizeAngle(radians(value)) })),
    ];
    const labels = ["x [m] ", "y [m] ", "θ [°] "];
    const live = this.state.report.live;
    replace(this.tools,
      h("p", { class: "soft" }, "Drag the map; turn it by its handle, or drag with Shift. Keys: arrows by a cell, q and e by half a degree, with Shift more."),
      h("div", { class: "pose-inputs" }, ...this.inputs.map((input, i) => h("label", {}, labels[i], input.field.element))),
      this.poseNote, this.placeLine, this.gauge.element,
      h("div", { class: "buttons" },
        h("button", {
          type: "button", id: "hand-refine", disabled: !live, click: () => void this.refine(),
          title: live ? "Climb to the best fit near here" : "Needs a running gridmerge: gridmerge view DIR",
        }, "Refine from here"),
        h("button", {
          type: "button", id: "hand-next", disabled: this.places.length === 0, click: () => this.toNextPlace(),
          title: "Lay it where a comparison has it, the most probable place first",
        }, this.places.length > 1 ? "Next place" : "Likely place"),
        h("button", { type: "button", click: () => this.leave(() => this.state.putBack(map)) }, "Put back"),
        h("button", { type: "button", click: () => this.leave(() => this.state.letGo()) }, "Let go")),
      live ? null : h("p", { class: "soft" }, "To refine with the engine, open this folder with ", h("code", {}, "gridmerge view DIR"), "."),
      this.answer);
  }

  /** The buttons go with the map, and the focus must not be lost with them. */
  private leave(act: () => void): void {
    act();
    this.picker.focus();
  }

  private poseInput(
    part: "x" | "y" | "theta", most: number, step: number, get: (pose: SE2) => number, set: (pose: SE2, value: number) => SE2): PoseInput {
    const field = new NumberField({
      id: `hand-${part}`, what: part === "theta" ? "θ" : part, least: -most, most, step, note: "hand-pose-note", typed: () => {
        const map = this.state.handled;
        const pose = map === null ? null : this.state.poseOf(map);
        if (map !== null && pose && field.value !== null) this.state.put(map, set(pose, field.value));
        else this.update();
      },
    });
    // Who leaves the field sees where the map lies.
    field.element.addEventListener("blur", () => this.update());
    return { field, get };
  }

  private poseProblem(): string | null {
    return this.inputs.map(({ field }) => field.problem).find((problem) => problem !== null) ?? null;
  }

  private tellPose(): void {
    const problem = this.poseProblem();
    say(this.poseNote, problem === null ? "" : `${problem}: the map stays where it was.`);
  }

  private score(): void {
    this.scoring = 0;
    const inHand = this.state.inHand();
    if (!inHand) return;
    const { map, grid, pose } = inHand;
    const others = laid(this.others(map), (placed) => this.state.gridOf(placed));
    const scorer = this.scorerOf(map, grid);
    this.gauge.show(scorer.score(pose, others));
    // Worked out once for the same maps at the same places.
    const key = JSON.stringify([map, this.others(map), this.state.bent, this.state.grids.map((known) => known !== null)]);
    if (key === this.yardstickOf) return;
    this.yardstickOf = key;
    const isRunning = this.yardstick !== null;
    this.yardstick = yardstickOf(scorer, grid, others, laid(this.members(), (placed) => this.state.bentGridOf(placed)));
    this.gauge.hold(null);
    if (!isRunning) this.workOutYardstick();
  }

  /** The maps of the scene as they were merged. */
  private members(): Placed[] {
    return this.state.scene.component === null ? [] : this.state.scene.placed;
  }

  /** A few milliseconds a frame. */
  private workOutYardstick(): void {
    requestAnimationFrame(() => {
      const until = performance.now() + yardstickBudget;
      while (this.yardstick && performance.now() < until) {
        const step = this.yardstick.next();
        if (!step.done) continue;
        this.yardstick = null;
        this.gauge.hold(step.value);
      }
      if (this.yardstick) this.workOutYardstick();
    });
  }

  private scorerOf(map: number, grid: Grid): Scorer {
    let scorer = this.scorers.get(map);
    if (!scorer) this.scorers.set(map, (scorer = new Scorer(grid)));
    return scorer;
  }
}
