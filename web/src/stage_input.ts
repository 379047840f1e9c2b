// SPDX-License-Identifier: Apache-2.0
import { radians } from "./numbers";
import { type Point, type SE2, apply, moved } from "./se2";
import type { Stage } from "./stage";
import { handleOf, inside, outline } from "./stamp";
import type { State } from "./state";
import { toScene, toScreen } from "./viewport";

/** What the pointer that went down does until it goes up. */
type Grip = "view" | "shift" | "turn";

const panStep = 60; // pixels
const zoomStep = 1.3;

/** What the keyboard asks for that is not the stage's own business. */
export interface KeyActions {
  toggleMap(index: number): void;
  toggleMerged(): void;
  toggleAgreement(): void;
  help(): void;
  refine(): void;
}

/** Mouse, touch and keyboard on the stage: looking around, and moving the map in hand. */
export class StageInput {
  private readonly stage: Stage;
  private readonly state: State;
  private readonly actions: KeyActions;
  private readonly pointers = new Map<number, Point>();
  private grip: Grip = "view";

  constructor(stage: Stage, state: State, actions: KeyActions) {
    this.stage = stage;
    this.state = state;
    this.actions = actions;
    const { canvas } = stage;
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.up(event));
    canvas.addEventListener("pointercancel", (event) => this.up(event));
    canvas.addEventListener("pointerleave", () => this.pointers.size === 0 && stage.pointAt(null));
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    canvas.addEventListener("dblclick", (event) => stage.zoom(2, pixelOf(event)));
    canvas.addEventListener("keydown", (event) => this.key(event));
    canvas.addEventListener("blur", () => this.setCrosshair(false));
  }

  private down(event: PointerEvent): void {
    if (event.button > 1) return;
    this.stage.canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, pixelOf(event));
    this.setCrosshair(false);
    this.grip = this.pointers.size === 1 ? this.gripAt(pixelOf(event), event.shiftKey) : "view";
    this.stage.canvas.classList.toggle("grabbing", true);
  }

  private gripAt(pixel: Point, turning: boolean): Grip {
    const { handled } = this.state;
    const grid = handled === null ? null : this.state.grids[handled];
    const pose = handled === null ? null : this.state.poseOf(handled);
    if (!grid || !pose) return "view";
    const { view } = this.stage;
    const handle = handleOf(view, grid, pose).at;
    if (Math.hypot(handle.x - pixel.x, handle.y - pixel.y) < 20) return "turn";
    if (!inside(outline(view, grid, pose), pixel)) return "view";
    return turning ? "turn" : "shift";
  }

  private move(event: PointerEvent): void {
    const to = pixelOf(event);
    const from = this.pointers.get(event.pointerId);
    if (from) {
      if (this.pointers.size === 2) this.pinch(event.pointerId, to);
      else this.drag(from, to);
      this.pointers.set(event.pointerId, to);
    }
    this.stage.pointAt(to);
  }

  private drag(from: Point, to: Point): void {
    if (this.grip === "view") {
      this.stage.pan(to.x - from.x, to.y - from.y);
      return;
    }
    const { view } = this.stage;
    if (this.grip === "shift") {
      const a = toScene(view, from);
      const b = toScene(view, to);
      this.moveHandled(b.x - a.x, b.y - a.y, 0);
      return;
    }
    const pivot = this.pivot();
    if (!pivot) return;
    const middle = toScreen(view, apply(pivot.pose, pivot.middle));
    const angle = (p: Point) => Math.atan2(middle.y - p.y, p.x - middle.x);
    this.moveHandled(0, 0, angle(to) - angle(from));
  }

  private pinch(moving: number, to: Point): void {
    const from = this.pointers.get(moving)!;
    const other = [...this.pointers].find(([id]) => id !== moving)![1];
    const before = Math.max(10, Math.hypot(from.x - other.x, from.y - other.y));
    const after = Math.max(10, Math.hypot(to.x - other.x, to.y - other.y));
    this.stage.pan((to.x - from.x) / 2, (to.y - from.y) / 2);
    this.stage.zoom(after / before, { x: (to.x + other.x) / 2, y: (to.y + other.y) / 2 });
  }

  private up(event: PointerEvent): void {
    this.pointers.delete(event.pointerId);
    // The finger that stays after a pinch moves the view, whatever it is on.
    this.grip = "view";
    if (this.pointers.size === 0) this.stage.canvas.classList.toggle("grabbing", false);
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    const unit = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 30 : event.deltaMode === WheelEvent.DOM_DELTA_PAGE ? 300 : 1;
    const amount = Math.max(-300, Math.min(300, event.deltaY * unit));
    this.stage.zoom(Math.exp(-amount / 400), pixelOf(event));
  }

  private pivot(): { pose: SE2; middle: Point } | null {
    const { handled } = this.state;
    const grid = handled === null ? null : this.state.grids[handled];
    const pose = handled === null ? null : this.state.poseOf(handled);
    return grid && pose ? { pose, middle: grid.middle() } : null;
  }

  /** Metres and radians, about the map's middle. */
  private moveHandled(dx: number, dy: number, turn: number): void {
    const pivot = this.pivot();
    if (pivot) this.state.put(this.state.handled!, moved(pivot.pose, dx, dy, turn, pivot.middle));
  }

  private setCrosshair(shown: boolean): void {
    if (this.stage.crosshair === shown) return;
    this.stage.crosshair = shown;
    const { width, height } = this.stage.view;
    this.stage.pointAt(shown ? { x: width / 2, y: height / 2 } : null);
    this.stage.redraw();
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const done = this.handKey(event) || this.viewKey(event) || this.layerKey(event);
    if (!done) return;
    event.preventDefault();
  }

  /** With a map in hand the arrows move it, by a cell, or with Shift by ten. */
  private handKey(event: KeyboardEvent): boolean {
    const { handled } = this.state;
    if (handled === null) return false;
    const step = (event.shiftKey ? 10 : 1) * this.state.report.maps[handled].resolution;
    const turn = radians(event.shiftKey ? 5 : 0.5);
    switch (event.key) {
      case "ArrowLeft":
        this.moveHandled(-step, 0, 0);
        return true;
      case "ArrowRight":
        this.moveHandled(step, 0, 0);
        return true;
      case "ArrowUp":
        this.moveHandled(0, step, 0);
        return true;
      case "ArrowDown":
        this.moveHandled(0, -step, 0);
        return true;
      case "q":
      case "Q":
        this.moveHandled(0, 0, turn);
        return true;
      case "e":
      case "E":
        this.moveHandled(0, 0, -turn);
        return true;
      case "Enter":
        this.actions.refine();
        return true;
      case "Escape":
        this.state.take(null);
        return true;
      default:
        return false;
    }
  }

  private viewKey(event: KeyboardEvent): boolean {
    const { stage } = this;
    const shifts: Record<string, [number, number]> = {
      ArrowLeft: [panStep, 0], ArrowRight: [-panStep, 0], ArrowUp: [0, panStep], ArrowDown: [0, -panStep],
    };
    const shift = shifts[event.key];
    if (shift || "+=-".includes(event.key)) this.setCrosshair(true);
    if (shift) stage.pan(...shift);
    else if (event.key === "+" || event.key === "=") stage.zoom(zoomStep);
    else if (event.key === "-") stage.zoom(1 / zoomStep);
    else if (event.key === "0") stage.fit();
    else if (event.key === "g") {
      stage.gridShown = !stage.gridShown;
      stage.redraw();
    } else return false;
    return true;
  }

  private layerKey(event: KeyboardEvent): boolean {
    if (/^[1-9]$/.test(event.key)) this.actions.toggleMap(Number(event.key) - 1);
    else if (event.key === "m") this.actions.toggleMerged();
    else if (event.key === "a") this.actions.toggleAgreement();
    else if (event.key === "?") this.actions.help();
    else return false;
    return true;
  }
}

function pixelOf(event: MouseEvent): Point {
  return { x: event.offsetX, y: event.offsetY };
}
