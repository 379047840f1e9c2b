// SPDX-License-Identifier: Apache-2.0
import { fixed } from "./numbers";
import { type Ruler, lengthOf } from "./ruler";
import { type Viewport, multiples, roundStep, toScreen, visibleBox } from "./viewport";

/** Colours of what is drawn over maps, as the page's style has them. */
export interface DecorColors {
  line: string;
  text: string;
  halo: string;
}

const leastSpacing = 70;

function decimalsOf(step: number): number {
  return Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
}

export function label(context: CanvasRenderingContext2D, colors: DecorColors, text: string, x: number, y: number): void {
  context.lineJoin = "round";
  context.lineWidth = 3;
  context.strokeStyle = colors.halo;
  context.strokeText(text, x, y);
  context.fillStyle = colors.text;
  context.fillText(text, x, y);
}

/** The path as a line that stands out from whatever it is drawn on. */
function strokeOnHalo(context: CanvasRenderingContext2D, colors: DecorColors, width: number, haloWidth: number): void {
  context.lineWidth = haloWidth;
  context.strokeStyle = colors.halo;
  context.stroke();
  context.lineWidth = width;
  context.strokeStyle = colors.text;
  context.stroke();
}

/** Lines at round metres, with their coordinates along the upper and left edges. Sizes are in CSS pixels. */
export function drawGrid(context: CanvasRenderingContext2D, view: Viewport, colors: DecorColors): void {
  const step = roundStep(leastSpacing / view.scale);
  const box = visibleBox(view);
  const decimals = decimalsOf(step);
  context.save();
  context.font = "11px system-ui, sans-serif";
  context.strokeStyle = colors.line;
  context.lineWidth = 1;
  context.beginPath();
  const columns = multiples(step, box.left, box.right);
  const rows = multiples(step, box.bottom, box.top);
  for (const x of columns) {
    const at = Math.round(toScreen(view, { x, y: 0 }).x) + 0.5;
    context.moveTo(at, 0);
    context.lineTo(at, view.height);
  }
  for (const y of rows) {
    const at = Math.round(toScreen(view, { x: 0, y }).y) + 0.5;
    context.moveTo(0, at);
    context.lineTo(view.width, at);
  }
  context.stroke();
  context.textBaseline = "top";
  context.textAlign = "center";
  for (const x of columns) label(context, colors, fixed(x, decimals), toScreen(view, { x, y: 0 }).x, 4);
  context.textBaseline = "middle";
  context.textAlign = "left";
  for (const y of rows) {
    const at = toScreen(view, { x: 0, y }).y;
    if (at > 22) label(context, colors, fixed(y, decimals), 4, at);
  }
  context.restore();
}

/** The frame's origin, its axes told by letters, not by colours. */
export function drawAxes(context: CanvasRenderingContext2D, view: Viewport, colors: DecorColors): void {
  const origin = toScreen(view, { x: 0, y: 0 });
  context.save();
  context.font = "bold 12px system-ui, sans-serif";
  context.textAlign = "center";
  context.textBaseline = "middle";
  for (const [dx, dy, text] of [[34, 0, "x"], [0, -34, "y"]] as const) {
    context.beginPath();
    context.moveTo(origin.x, origin.y);
    context.lineTo(origin.x + dx, origin.y + dy);
    strokeOnHalo(context, colors, 2, 5);
    label(context, colors, text, origin.x + dx * 1.3, origin.y + dy * 1.3);
  }
  context.restore();
}

/** A bar in the lower right corner, a round number of metres long. */
export function drawScaleBar(context: CanvasRenderingContext2D, view: Viewport, colors: DecorColors): void {
  const metres = roundStep(80 / view.scale);
  const length = metres * view.scale;
  const right = view.width - 14;
  const bottom = view.height - 14;
  context.save();
  context.beginPath();
  context.moveTo(right - length, bottom - 7);
  context.lineTo(right - length, bottom);
  context.lineTo(right, bottom);
  context.lineTo(right, bottom - 7);
  strokeOnHalo(context, colors, 2, 6);
  context.font = "12px system-ui, sans-serif";
  context.textAlign = "center";
  context.textBaseline = "bottom";
  label(context, colors, `${metres < 1 ? fixed(metres, decimalsOf(metres)) : metres} m`, right - length / 2, bottom - 4);
  context.restore();
}

/** What is measured: a line with its length. */
export function drawRuler(context: CanvasRenderingContext2D, view: Viewport, colors: DecorColors, ruler: Ruler): void {
  if (!ruler.from) return;
  const from = toScreen(view, ruler.from);
  const to = toScreen(view, ruler.to ?? ruler.from);
  context.save();
  context.beginPath();
  context.moveTo(from.x, from.y);
  context.lineTo(to.x, to.y);
  strokeOnHalo(context, colors, 2, 5);
  for (const end of [from, to]) {
    context.beginPath();
    context.arc(end.x, end.y, 4, 0, 2 * Math.PI);
    strokeOnHalo(context, colors, 2, 5);
  }
  context.font = "bold 13px system-ui, sans-serif";
  context.textAlign = "center";
  context.textBaseline = "middle";
  const pixels = Math.hypot(to.x - from.x, to.y - from.y);
  if (pixels > 12) {
    // Beside the middle of the line, on its upper side, as far off as the text is wide there.
    const text = lengthOf(ruler);
    const side = to.x >= from.x ? 1 : -1;
    const across = { x: (side * (to.y - from.y)) / pixels, y: (side * (from.x - to.x)) / pixels };
    const off = 8 + 6 * Math.abs(across.y) + (context.measureText(text).width / 2) * Math.abs(across.x);
    label(context, colors, text, (from.x + to.x) / 2 + off * across.x, (from.y + to.y) / 2 + off * across.y);
  }
  context.restore();
}

/** Where the keyboard's cursor is: in the middle. */
export function drawCrosshair(context: CanvasRenderingContext2D, view: Viewport, colors: DecorColors): void {
  const x = Math.round(view.width / 2) + 0.5;
  const y = Math.round(view.height / 2) + 0.5;
  context.save();
  context.beginPath();
  context.moveTo(x - 9, y);
  context.lineTo(x + 9, y);
  context.moveTo(x, y - 9);
  context.lineTo(x, y + 9);
  strokeOnHalo(context, colors, 1.5, 4);
  context.restore();
}
