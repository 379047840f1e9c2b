// SPDX-License-Identifier: Apache-2.0
import { parseColor } from "./color";
import type { Picture } from "./compose";
import { drawArrows } from "./arrows";
import { type DecorColors, drawAxes, drawCrosshair, drawGrid, drawRuler, drawScaleBar, label } from "./decor";
import { h } from "./dom";
import { Grid } from "./grid";
import { smallest } from "./numbers";
import { placeOf } from "./scene";
import type { Point, SE2 } from "./se2";
import { Stamp, handleOf, outline } from "./stamp";
import type { State } from "./state";
import { Tiles } from "./tiles";
import { type Viewport, boxAround, fit, looking, panned, toScene, zoomed } from "./viewport";

const paintBudget = 9; // milliseconds a frame
const handleRoom = 48; // pixels about a handle: as wide as the buttons beside the map
const printRatio = 2; // pixels of a printed picture for each of the screen

/** Where a view looks: the point in its middle, and how many metres its shorter side shows. */
export interface Aim {
  center: Point;
  metres: number;
}

/** The canvas that shows a scene: what is drawn, and from where it is looked at. */
export class Stage {
  readonly canvas: HTMLCanvasElement;
  view: Viewport = { width: 1, height: 1, center: { x: 0, y: 0 }, scale: 20 };
  gridShown = true;
  /** Keyboard users point with the middle of the canvas. */
  crosshair = false;
  private readonly state: State;
  private readonly context: CanvasRenderingContext2D;
  private readonly tiles = new Tiles();
  private readonly stamps = new Map<string, Stamp>();
  private place = "";
  private shown = "";
  private ratio = 1;
  private frame = 0;
  private touched = false;
  /** The map that was in hand when the view was fitted last. */
  private shownInHand: number | null = null;
  private sized = false;
  /** What is to be looked at as soon as the canvas has a size. */
  private awaited: Aim | null = null;
  /** Where the cursor is on the canvas. */
  private pixel: Point | null = null;
  /** The picture is to be made again before it is drawn; only for the same place do tiles stand in until then. */
  private stale: "no" | "similar" | "other" = "no";

  constructor(state: State) {
    this.state = state;
    this.canvas = h("canvas", {
      id: "stage",
      tabindex: 0,
      role: "application",
      "aria-label": "The maps, drawn over each other. Arrows move, plus and minus zoom, 0 shows all, ? lists all keys.",
    });
    this.context = this.canvas.getContext("2d", { alpha: false })!;
    state.on("scene", () => this.arrange());
    state.on("grids", () => this.arrange());
    for (const topic of ["looks", "colors", "hand", "bend"] as const) state.on(topic, () => this.recompose());
    state.on("hand", () => this.showHandle());
    for (const topic of ["spotlight", "ruler"] as const) state.on(topic, () => this.redraw());
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.redraw());
    window.addEventListener("beforeprint", () => this.setPrinting(true));
    window.addEventListener("afterprint", () => this.setPrinting(false));
  }

  /** Shows all of the scene. */
  fit(): void {
    const corners = this.state.placed().flatMap((placed) => this.state.gridOf(placed)?.corners(placed.T_scene_map) ?? []);
    const points = corners.length > 0 ? corners : this.mergedGrid()?.corners() ?? [];
    const plan = this.state.plan.visible ? this.state.placedPlan() : null;
    if (plan) points.push(...plan.grid.corners(plan.T_scene_map));
    this.look(this.withHandle(points, fit(boxAround(points), this.view.width, this.view.height)));
    this.touched = false;
  }

  /** A view that shows all shows the handle of a map that is taken in hand, and does without it again. */
  private showHandle(): void {
    if (this.shownInHand === this.state.handled) return;
    this.shownInHand = this.state.handled;
    if (!this.touched) this.fit();
  }

  /** A view of these points where the handle of the map in hand can be taken hold of, beside the buttons too. */
  private withHandle(points: Point[], view: Viewport): Viewport {
    const inHand = this.state.inHand();
    if (!inHand) return view;
    const { x, y } = handleOf(view, inHand.grid, inHand.pose).at;
    const reach = [{ x: x - handleRoom, y: y - handleRoom }, { x: x + handleRoom, y: y + handleRoom }];
    return fit(boxAround([...points, ...reach.map((pixel) => toScene(view, pixel))]), view.width, view.height);
  }

  /** Null where the view shows all of the scene, however large it is. */
  get aim(): Aim | null {
    const { center, width, height, scale } = this.view;
    return this.touched ? { center, metres: Math.min(width, height) / scale } : null;
  }

  /** Null: all of the scene. */
  lookAt(aim: Aim | null): void {
    const { width, height } = this.view;
    this.awaited = this.sized ? null : aim;
    if (!aim) this.fit();
    else this.look(looking(aim.center, aim.metres, width, height));
  }

  /** A map of the scene, with what lies around it. */
  lookAtMap(map: number): void {
    const pose = this.state.poseOf(map);
    if (!pose) return;
    const { left, bottom, right, top } = boxAround(Grid.cornersOf(this.state.report.maps[map], pose));
    const margin = 0.5 * Math.max(right - left, top - bottom);
    this.look(fit({ left: left - margin, bottom: bottom - margin, right: right + margin, top: top + margin }, this.view.width, this.view.height));
  }

  /** What is seen, as a PNG, when all of it is drawn. */
  picture(): Promise<Blob | null> {
    this.draw(Infinity);
    return new Promise((done) => this.canvas.toBlob(done, "image/png"));
  }

  pan(dx: number, dy: number): void {
    this.look(panned(this.view, dx, dy));
  }

  zoom(factor: number, at: Point = { x: this.view.width / 2, y: this.view.height / 2 }): void {
    this.look(zoomed(this.view, factor, at));
  }

  toggleGrid(): void {
    this.showGrid(!this.gridShown);
  }

  showGrid(shown: boolean): void {
    this.gridShown = shown;
    this.state.changed("metres");
    this.redraw();
  }

  /** The cursor at a pixel of the canvas; null: nowhere. */
  pointAt(pixel: Point | null): void {
    this.pixel = pixel;
    this.readCursor();
  }

  private readCursor(): void {
    const { state } = this;
    state.cursor = this.pixel && toScene(this.view, this.pixel);
    state.changed("cursor");
    if (state.ruler?.open && state.cursor) state.measure({ ...state.ruler, to: state.cursor });
  }

  redraw(): void {
    if (this.frame === 0) this.frame = requestAnimationFrame(() => this.draw());
  }

  /** Paper is white and fine, whatever the screen is. */
  private setPrinting(isPrinting: boolean): void {
    document.documentElement.classList.toggle("printing", isPrinting);
    this.setRatio(Math.max(isPrinting ? printRatio : 1, window.devicePixelRatio || 1));
    this.draw(isPrinting ? Infinity : paintBudget);
  }

  private setRatio(ratio: number): void {
    this.ratio = ratio;
    this.canvas.width = Math.round(this.view.width * ratio);
    this.canvas.height = Math.round(this.view.height * ratio);
  }

  private look(view: Viewport): void {
    this.view = view;
    this.touched = true;
    this.readCursor();
    this.redraw();
  }

  private resize(): void {
    const { width, height } = this.canvas.getBoundingClientRect();
    const isPrinting = document.documentElement.classList.contains("printing");
    if (width === 0 || height === 0 || isPrinting) return;
    this.view = { ...this.view, width, height };
    this.setRatio(window.devicePixelRatio || 1);
    this.sized = true;
    if (this.awaited) this.lookAt(this.awaited);
    else if (!this.touched) this.fit();
    this.redraw();
  }

  private mergedGrid(): Grid | null {
    const { component } = this.state.scene;
    return component === null ? null : this.state.mergedGrids[component];
  }

  private arrange(): void {
    const place = placeOf(this.state.scene.id);
    const moved = place !== this.place;
    this.place = place;
    if (moved) this.stale = "other";
    this.recompose();
    this.readCursor();
    if (moved || !this.touched) this.fit();
  }

  private recompose(): void {
    if (this.stale === "no") this.stale = "similar";
    this.redraw();
  }

  private compose(): void {
    const { state } = this;
    const similar = this.stale === "similar";
    this.stale = "no";
    const layers: Picture["layers"] = [];
    const byHand = state.byHand();
    const parts: unknown[] = [this.place, state.merged, state.agreement];
    for (const placed of state.placed()) {
      const { map, T_scene_map } = placed;
      const grid = state.gridOf(placed);
      const look = state.looks[map];
      if (!grid || map === state.handled) continue;
      layers.push({
        grid, T_scene_map, color: parseColor(look.color), opacity: look.visible ? look.opacity : 0,
        above: byHand.has(map),
      });
      parts.push(map, T_scene_map, look, placed.deformation ? state.bent : 0);
    }
    const grid = this.mergedGrid();
    parts.push(grid !== null);
    const plan = state.plan.visible ? state.placedPlan() : null;
    parts.push(plan !== null && state.plan.opacity);
    // A map in hand is no part of the picture: while it moves, nothing has to be painted anew.
    const shown = JSON.stringify(parts);
    if (shown === this.shown) return;
    this.shown = shown;
    const picture: Picture = {
      merged: grid && state.merged.visible ? { grid, opacity: state.merged.opacity } : null,
      layers,
      agreement: state.agreement.visible ? state.agreement.opacity : 0,
      plan: plan && { ...plan, opacity: state.plan.opacity },
    };
    const resolutions = layers.map((layer) => layer.grid.finest.resolution);
    if (grid) resolutions.push(grid.finest.resolution);
    this.tiles.show(picture, resolutions.length > 0 ? smallest(resolutions) : 0.05, similar);
  }

  private colors(): DecorColors & { unknown: string } {
    const style = getComputedStyle(document.documentElement);
    const of = (name: string) => style.getPropertyValue(name).trim();
    return { line: of("--grid"), text: of("--ink"), halo: of("--halo"), unknown: of("--unknown") };
  }

  private draw(budget = paintBudget): void {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    if (this.stale !== "no") this.compose();
    const { context, view, ratio } = this;
    const colors = this.colors();
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.fillStyle = colors.unknown;
    context.fillRect(0, 0, this.canvas.width, this.canvas.height);
    const complete = this.tiles.draw(context, scaledBy(view, ratio), budget);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.drawStamps();
    if (this.state.arrows) drawArrows(context, view, colors, this.state);
    if (this.gridShown) drawGrid(context, view, colors);
    if (this.gridShown) drawAxes(context, view, colors);
    this.drawByHand(colors);
    drawScaleBar(context, view, colors);
    if (this.state.ruler) drawRuler(context, view, colors, this.state.ruler);
    if (this.crosshair) drawCrosshair(context, view, colors);
    this.canvas.dataset.complete = String(complete);
    if (!complete) this.redraw();
  }

  private drawStamps(): void {
    const { handled, spotlight } = this.state;
    if (spotlight !== null && spotlight !== handled) this.drawStamp(spotlight, false);
    if (handled !== null) this.drawStamp(handled, true);
  }

  private drawStamp(map: number, inHand: boolean): void {
    const { context, view } = this;
    const placed = this.state.placed().find((one) => one.map === map);
    const grid = placed && this.state.gridOf(placed);
    if (!grid) return;
    const pose = placed.T_scene_map;
    const { color, visible } = this.state.looks[map];
    if (inHand || visible) this.stampOf(map, grid, color).draw(context, view, pose);
    this.drawOutline(outline(view, grid, pose), color);
    if (inHand) this.drawHandle(grid, pose, color);
  }

  private drawOutline(corners: Point[], color: string): void {
    const { context } = this;
    context.strokeStyle = color;
    context.lineWidth = 2;
    context.setLineDash([6, 4]);
    context.beginPath();
    for (const corner of corners) context.lineTo(corner.x, corner.y);
    context.closePath();
    context.stroke();
    context.setLineDash([]);
  }

  /** Says in the picture itself, which is saved and printed, what does not lie as it was merged. */
  private drawByHand(colors: DecorColors): void {
    const { context, state, view } = this;
    context.save();
    context.font = "bold 12px system-ui, sans-serif";
    context.textAlign = "center";
    context.textBaseline = "bottom";
    for (const [map, pose] of state.byHand()) {
      const grid = state.grids[map];
      const { color, visible } = state.looks[map];
      if (!grid || !(visible || map === state.handled)) continue;
      const corners = outline(view, grid, pose);
      if (map !== state.handled) this.drawOutline(corners, color);
      const top = corners.reduce((highest, corner) => (corner.y < highest.y ? corner : highest));
      // In sight, where the corner is not: below the numbers of the grid.
      const x = Math.min(Math.max(top.x, 60), view.width - 60);
      label(context, colors, `${map + 1} by hand`, x, Math.min(Math.max(top.y - 4, 36), view.height - 30));
    }
    context.restore();
  }

  private drawHandle(grid: Grid, pose: SE2, color: string): void {
    const { context } = this;
    const handle = handleOf(this.view, grid, pose);
    context.beginPath();
    context.moveTo(handle.from.x, handle.from.y);
    context.lineTo(handle.at.x, handle.at.y);
    context.stroke();
    context.beginPath();
    context.arc(handle.at.x, handle.at.y, 9, 0, 2 * Math.PI);
    context.fillStyle = color;
    context.fill();
    context.strokeStyle = "#fff";
    context.stroke();
  }

  private stampOf(map: number, grid: Grid, color: string): Stamp {
    const key = `${map} ${color}`;
    let stamp = this.stamps.get(key);
    if (stamp?.grid !== grid) {
      this.stamps.delete(key);
      // A few are enough: those that were pointed at last.
      if (this.stamps.size >= 8) this.stamps.delete(this.stamps.keys().next().value!);
      this.stamps.set(key, (stamp = new Stamp(grid, color)));
    }
    return stamp;
  }
}

/** The same part of the scene, on a canvas with `ratio` times as many pixels. */
function scaledBy(view: Viewport, ratio: number): Viewport {
  return { width: view.width * ratio, height: view.height * ratio, center: view.center, scale: view.scale * ratio };
}
