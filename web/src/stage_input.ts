// SPDX-License-Identifier: Apache-2.0
import { radians } from "./numbers";
import { type Point, apply, moved } from "./se2";
import { put } from "./ruler";
import type { Stage } from "./stage";
import { handleOf, inside, outline } from "./stamp";
import type { State } from "./state";
import { toScene, toScreen } from "./viewport";

/** What the pointer that went down does until it goes up. */
type Grip = "view" | "shift" | "turn" | "measure";

const panStep = 60; // pixels
const zoomStep = 1.3;
const dragged = 4; // pixels: a pointer that moves less has clicked

/** What the keyboard asks for that is not the stage's own business. */
export interface KeyActions {
  toggleMap(map: number): void;
  toggleMerged(): void;
  toggleAgreement(): void;
  togglePlan(): void;
  toggleRuler(): void;
  toggleGrid(): void;
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
  /** Where the pointer went down. */
  private start: Point = { x: 0, y: 0 };

  constructor(stage: Stage, state: State, actions: KeyActions) {
    this.stage = stage;
    this.state = state;
    this.actions = actions;
    const { canvas } = stage;
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.up(event));
    canvas.addEventListener("pointercancel", (event) => this.up(event));
    // A finger that is lifted has left, but what it touched is what the user wants to know.
    canvas.addEventListener("pointerleave", (event) => {
      if (this.pointers.size === 0 && event.pointerType !== "touch") stage.pointAt(null);
    });
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
    this.start = pixelOf(event);
    if (this.pointers.size > 1) this.grip = "view";
    else if (this.state.ruler && event.button === 0) this.grip = "measure";
    else this.grip = this.gripAt(this.start, event.shiftKey);
    if (this.grip === "measure") this.putRuler(this.start);
    else this.stage.canvas.classList.add("grabbing");
  }

  private gripAt(pixel: Point, turning: boolean): Grip {
    const inHand = this.state.inHand();
    if (!inHand) return "view";
    const { grid, pose } = inHand;
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
    if (this.grip === "measure") return; // an end of the ruler follows the cursor
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
    const inHand = this.state.inHand();
    if (!inHand) return;
    const middle = toScreen(view, apply(inHand.pose, inHand.grid.middle()));
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

  /** Puts an end of the ruler at a pixel. */
  private putRuler(pixel: Point): void {
    if (this.state.ruler) this.state.measure(put(this.state.ruler, toScene(this.stage.view, pixel)));
  }

  private up(event: PointerEvent): void {
    this.pointers.delete(event.pointerId);
    const at = pixelOf(event);
    const wasDragged = Math.hypot(at.x - this.start.x, at.y - this.start.y) > dragged;
    if (this.grip === "measure" && wasDragged && this.state.ruler?.open) this.putRuler(at);
    // The finger that stays after a pinch moves the view, whatever it is on.
    this.grip = "view";
    if (this.pointers.size === 0) this.stage.canvas.classList.remove("grabbing");
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    const unit = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 30 : event.deltaMode === WheelEvent.DOM_DELTA_PAGE ? 300 : 1;
    const amount = Math.max(-300, Math.min(300, event.deltaY * unit));
    this.stage.zoom(Math.exp(-amount / 400), pixelOf(event));
  }

  /** Metres and radians, about the map's middle. */
  private moveHandled(dx: number, dy: number, turn: number): void {
    const inHand = this.state.inHand();
    if (inHand) this.state.put(inHand.map, moved(inHand.pose, dx, dy, turn, inHand.grid.middle()));
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
    if (this.rulerKey(event) || this.handKey(event) || this.viewKey(event) || this.layerKey(event)) event.preventDefault();
  }

  /** With the ruler, Enter puts an end in the middle of the view. */
  private rulerKey(event: KeyboardEvent): boolean {
    if (event.key.toLowerCase() === "r" || (event.key === "Escape" && this.state.ruler)) this.actions.toggleRuler();
    else if (event.key === "Enter" && this.state.ruler) {
      this.setCrosshair(true);
      this.putRuler({ x: this.stage.view.width / 2, y: this.stage.view.height / 2 });
    } else return false;
    return true;
  }

  /** With a map in hand the arrows move it, by a cell, or with Shift by ten. */
  private handKey(event: KeyboardEvent): boolean {
    const { handled } = this.state;
    if (handled === null) return false;
    const { resolution, coarser } = this.state.report.maps[handled];
    const step = ((event.shiftKey ? 10 : 1) * resolution) / (coarser ?? 1);
    const turn = radians(event.shiftKey ? 5 : 0.5);
    switch (event.key.length === 1 ? event.key.toLowerCase() : event.key) {
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
        this.moveHandled(0, 0, turn);
        return true;
      case "e":
        this.moveHandled(0, 0, -turn);
        return true;
      case "Enter":
        this.actions.refine();
        return true;
      case "Escape":
        this.state.letGo();
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
    else if (event.key.toLowerCase() === "g") this.actions.toggleGrid();
    else return false;
    return true;
  }

  private layerKey(event: KeyboardEvent): boolean {
    const key = event.key.toLowerCase();
    if (/^[1-9]$/.test(key)) this.actions.toggleMap(Number(key) - 1);
    else if (key === "m") this.actions.toggleMerged();
    else if (key === "a") this.actions.toggleAgreement();
    else if (key === "p") this.actions.togglePlan();
    else if (key === "?") this.actions.help();
    else return false;
    return true;
  }
}

function pixelOf(event: MouseEvent): Point {
  return { x: event.offsetX, y: event.offsetY };
}
