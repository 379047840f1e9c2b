// SPDX-License-Identifier: Apache-2.0
import { type Picture, extentOf, paint } from "./compose";
import { type Box, type Viewport, toScreen, visibleBox } from "./viewport";

const tilePixels = 256;
/** Tiles that are kept: 256 KiB each. */
const mostTiles = 400;

interface Tile {
  canvas: HTMLCanvasElement;
  /** Of the picture that it shows. */
  edition: number;
  usedAt: number;
}

interface Place {
  level: number;
  column: number;
  row: number;
}

/**
 * Draws a picture of any size: in square tiles at the scale that is asked for, kept until the picture changes. Tiles
 * are painted a few at a time, so that the page never stalls; until then coarser or older ones stand in.
 */
export class Tiles {
  private tiles = new Map<string, Tile>();
  private edition = 0;
  private clock = 0;
  private picture: Picture = { merged: null, layers: [], agreement: 0 };
  private extent: Box = extentOf(this.picture);
  private resolution = 0.05;

  /** Another picture, of the same place if `similar`: then what is painted stands in until it is painted anew. */
  show(picture: Picture, resolution: number, similar: boolean): void {
    if (!similar || resolution !== this.resolution) this.tiles.clear();
    this.picture = picture;
    this.extent = extentOf(picture);
    this.resolution = resolution;
    this.edition++;
  }

  /**
   * Draws what is visible, painting missing tiles for `budget` milliseconds at most (one tile at least). Returns
   * whether all of it is now as it should be.
   */
  draw(context: CanvasRenderingContext2D, view: Viewport, budget: number): boolean {
    this.clock++;
    const level = Math.max(0, Math.round(Math.log2(1 / (this.resolution * view.scale))));
    const places = this.visible(level, view);
    const complete = this.paintMissing(places, budget);
    for (const place of places) this.drawOne(context, view, place);
    this.forget();
    return complete;
  }

  private visible(level: number, view: Viewport): Place[] {
    const side = this.sideOf(level);
    const box = intersection(visibleBox(view), this.extent);
    if (!box) return [];
    const places: Place[] = [];
    for (let row = Math.floor(box.bottom / side); row * side < box.top; row++) {
      for (let column = Math.floor(box.left / side); column * side < box.right; column++) {
        places.push({ level, column, row });
      }
    }
    const middle = { x: view.center.x / side - 0.5, y: view.center.y / side - 0.5 };
    const distance = (place: Place) => Math.hypot(place.column - middle.x, place.row - middle.y);
    return places.sort((a, b) => distance(a) - distance(b));
  }

  private paintMissing(places: Place[], budget: number): boolean {
    const until = performance.now() + budget;
    for (const place of places) {
      const tile = this.tiles.get(keyOf(place));
      if (tile && tile.edition === this.edition) continue;
      this.paintTile(place);
      if (performance.now() > until) return places.every((p) => this.tiles.get(keyOf(p))?.edition === this.edition);
    }
    return true;
  }

  private paintTile(place: Place): void {
    const side = this.sideOf(place.level);
    const pixels = paint(this.picture, {
      left: place.column * side,
      bottom: place.row * side,
      side: side / tilePixels,
      pixels: tilePixels,
    });
    const known = this.tiles.get(keyOf(place));
    const canvas = known?.canvas ?? document.createElement("canvas");
    canvas.width = canvas.height = tilePixels;
    canvas.getContext("2d")!.putImageData(new ImageData(pixels, tilePixels, tilePixels), 0, 0);
    this.tiles.set(keyOf(place), { canvas, edition: this.edition, usedAt: this.clock });
  }

  private drawOne(context: CanvasRenderingContext2D, view: Viewport, place: Place): void {
    const [left, top, width, height] = this.screenSquare(view, place);
    for (let up = 0; up <= 8; up++) {
      const column = Math.floor(place.column / 2 ** up);
      const row = Math.floor(place.row / 2 ** up);
      const tile = this.tiles.get(keyOf({ level: place.level + up, column, row }));
      if (!tile) continue;
      tile.usedAt = this.clock;
      const part = tilePixels / 2 ** up;
      const x = (place.column - column * 2 ** up) * part;
      const y = tilePixels - (place.row - row * 2 ** up + 1) * part;
      context.imageSmoothingEnabled = width < tilePixels;
      context.drawImage(tile.canvas, x, y, part, part, left, top, width, height);
      return;
    }
  }

  /** In whole pixels, so that neighbours meet without a seam. */
  private screenSquare(view: Viewport, place: Place): [number, number, number, number] {
    const side = this.sideOf(place.level);
    const upperLeft = toScreen(view, { x: place.column * side, y: (place.row + 1) * side });
    const lowerRight = toScreen(view, { x: (place.column + 1) * side, y: place.row * side });
    const left = Math.round(upperLeft.x);
    const top = Math.round(upperLeft.y);
    return [left, top, Math.round(lowerRight.x) - left, Math.round(lowerRight.y) - top];
  }

  private sideOf(level: number): number {
    return tilePixels * this.resolution * 2 ** level;
  }

  private forget(): void {
    if (this.tiles.size <= mostTiles) return;
    const oldest = [...this.tiles].sort(([, a], [, b]) => a.usedAt - b.usedAt);
    for (const [key] of oldest.slice(0, this.tiles.size - mostTiles)) this.tiles.delete(key);
  }
}

function keyOf(place: Place): string {
  return `${place.level}/${place.column}/${place.row}`;
}

function intersection(a: Box, b: Box): Box | null {
  const box = {
    left: Math.max(a.left, b.left),
    right: Math.min(a.right, b.right),
    bottom: Math.max(a.bottom, b.bottom),
    top: Math.min(a.top, b.top),
  };
  return box.left < box.right && box.bottom < box.top ? box : null;
}
