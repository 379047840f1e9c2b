// SPDX-License-Identifier: Apache-2.0
import { badge, focusPointsOut, mapLabel } from "./badge";
import { type Rgb, disagreement, ink, sepia, white } from "./color";
import { straighten } from "./deformation";
import { h, name, replace, swatch } from "./dom";
import { Cell } from "./grid";
import { fixed, probability, sayScale } from "./numbers";
import { type SE2, apply, inverse } from "./se2";
import { openWays } from "./open_ways";
import { type Component, type LeftOut, type PackedGrid, isLarge } from "./report";
import { moreNote, mostRows, searchBox } from "./search";
import type { Look, State } from "./state";
import { count, flat } from "./text";

const cellWords: Record<number, string> = { [Cell.unknown]: "unknown", [Cell.free]: "free", [Cell.occupied]: "wall" };

/** The layers of the scene: what is seen, in which colour and how strongly, and where the cursor is in each frame. */
export class LayersPanel {
  readonly element = h("div", { class: "panel", id: "panel-layers" });
  private readonly state: State;
  private readonly mapRows = h("div");
  private readonly ownRows = h("div");
  /** Maps that were left out, and ways that are open. */
  private readonly lists = h("div");
  private readonly showLeftOut: (map: number) => void;
  private readonly placeByHand: (map: number) => void;
  private readonly placeSo: (map: number, on: number, T_on_map: SE2) => void;
  private readings = new Map<number, HTMLElement>();
  private readonly boxes = new Map<HTMLInputElement, Look>();
  private readonly sliders = new Map<HTMLInputElement, Look>();
  private shownMaps = "";

  constructor(state: State, actions: {
    show(map: number): void; placeByHand(map: number): void; placeSo(map: number, on: number, T_on_map: SE2): void;
  }) {
    this.state = state;
    this.showLeftOut = actions.show;
    this.placeByHand = actions.placeByHand;
    replace(this.element, this.ownRows,
      h("div", { class: "row-heading" },
        h("h3", {}, "Maps"),
        h("button", { type: "button", click: () => this.setAll(true) }, "All"),
        h("button", { type: "button", click: () => this.setAll(false) }, "None")),
      isLarge(state.report) ? searchBox(state) : null,
      this.mapRows, this.lists);
    this.placeSo = actions.placeSo;
    state.on("scene", () => this.rebuild());
    for (const topic of ["hand", "query"] as const) state.on(topic, () => this.rebuild());
    state.on("looks", () => this.update());
    state.on("bend", () => this.tellBend());
    state.on("colors", () => this.recolor());
    for (const topic of ["cursor", "hand", "grids", "bend"] as const) state.on(topic, () => this.read());
    state.on("query", () => this.list());
    this.rebuild();
    this.list();
    for (const topic of ["scene", "hand", "query"] as const) state.on(topic, () => this.tellByHand());
  }

  toggle(look: Look): void {
    look.visible = !look.visible;
    this.state.changed("looks");
  }

  private setAll(visible: boolean): void {
    for (const { map } of this.state.placed()) this.state.looks[map].visible = visible;
    this.state.changed("looks");
  }

  private rebuild(): void {
    const { state } = this;
    const maps = state.placed().map(({ map }) => map);
    const found = isLarge(state.report) ? maps.filter((map) => state.isFound(map)) : maps;
    const listed = isLarge(state.report) ? found.slice(0, mostRows) : found;
    const key = JSON.stringify([state.scene.id, maps.length, found.length, listed]);
    if (key === this.shownMaps) return;
    this.shownMaps = key;
    const { component } = state.scene;
    replace(this.ownRows,
      component === null ? null : this.ownRow("merged", "Merged map", state.merged,
        h("span", { class: "legend soft" }, "Covers the maps that it is made of, where it has them. ",
          coarseness(state.report.components[component])), "m"),
      maps.length < 2 ? null : this.ownRow("agreement", "Agreement", state.agreement, h("span", { class: "legend" },
        legendItem(ink, "walls in two maps or more"), legendItem(white, "floor in two maps or more"),
        legendItem(disagreement, "they contradict each other"),
        component === null ? null : h("div", { class: "soft", id: "agreement-counts" }, agreementCounts(state.report.components[component], false))), "a"),
      this.planRow(),
      state.hasBent() ? bendRow(state) : null);
    this.readings = new Map();
    replace(this.mapRows, ...listed.map((map) => this.mapRow(map)), moreNote(isLarge(state.report) ? found.length : 0, "map"));
    this.read();
  }

  private planRow(): HTMLElement | null {
    const { plan } = this.state.report;
    const place = this.state.planPlace();
    if (!plan || !place) return null;
    const file = name(flat(plan.name).replace(/^.*\//, ""), plan.name);
    const words = `, ${sayScale(place.scale)}. ${coarseness(plan.grid!)}`;
    const doubt = `Its most probable place (probability ${probability(place.probability)}): nothing that is shown here hangs on it.`;
    return this.ownRow("plan", "Plan", this.state.plan, h("span", { class: "legend" },
      legendItem(sepia, "its walls"), h("div", { class: "soft" }, file, place.on_plan ? words : words + doubt)), "p");
  }

  private ownRow(id: string, label: string, look: Look, legend: Node | null, key: string): HTMLElement {
    return h("div", { class: "layer" },
      h("label", { class: "layer-name" }, this.checkbox(`layer-${id}`, look), label, keyHint(key)),
      this.slider(`strength-${id}`, label, look), legend);
  }

  private mapRow(map: number): HTMLElement {
    const { state } = this;
    const look = state.looks[map];
    const mapName = flat(state.names[map]);
    const reading = h("span", { class: "reading soft" }, "–");
    const coarser = coarseness(state.report.maps[map]);
    this.readings.set(map, reading);
    const color = h("input", {
      type: "color", id: `color-${map}`, value: look.color, "aria-label": `Colour of ${mapName}`, "data-map": map,
      input: (event) => {
        look.color = (event.target as HTMLInputElement).value;
        state.changed("colors");
      },
    });
    return focusPointsOut(h("div", { class: "layer", "data-map": map },
      h("label", { class: "layer-name" }, this.checkbox(`layer-${map}`, look), mapLabel(state, map), byHandTag(),
        map < 9 ? keyHint(String(map + 1)) : null),
      color, this.slider(`strength-${map}`, mapName, look), reading, coarser === "" ? null : h("span", { class: "legend soft" }, coarser)), state, map);
  }

  private checkbox(id: string, look: Look): HTMLInputElement {
    const box = h("input", { type: "checkbox", id, change: () => this.toggle(look) });
    box.checked = look.visible;
    this.boxes.set(box, look);
    return box;
  }

  private slider(id: string, label: string, look: Look): HTMLInputElement {
    const slider = h("input", {
      type: "range", id, min: 0, max: 100, value: 100 * look.opacity, "aria-label": `How strongly ${label} is drawn`,
      input: () => {
        look.opacity = Number(slider.value) / 100;
        this.state.changed("looks");
      },
    });
    this.sliders.set(slider, look);
    return slider;
  }

  private update(): void {
    for (const [box, look] of this.boxes) {
      if (box.isConnected) box.checked = look.visible;
      else this.boxes.delete(box);
    }
    for (const [slider, look] of this.sliders) {
      if (slider.isConnected) slider.value = String(100 * look.opacity);
      else this.sliders.delete(slider);
    }
  }

  /** A link to a view says it too. */
  private tellBend(): void {
    const slider = this.element.querySelector<HTMLInputElement>("#bent");
    const arrows = this.element.querySelector<HTMLInputElement>("#arrows");
    if (slider) slider.value = String(100 * this.state.bent);
    if (arrows) arrows.checked = this.state.arrows;
  }

  /** What was placed by hand lies otherwise than was merged and counted. */
  private tellByHand(): void {
    const byHand = this.state.byHand();
    for (const row of this.element.querySelectorAll<HTMLElement>("[data-map]")) {
      const tag = row.querySelector<HTMLElement>(".by-hand");
      if (tag) tag.hidden = !byHand.has(Number(row.dataset.map));
    }
    const { component } = this.state.scene;
    const counts = this.element.querySelector("#agreement-counts");
    if (counts && component !== null) counts.textContent = agreementCounts(this.state.report.components[component], byHand.size > 0);
  }

  private recolor(): void {
    for (const row of this.element.querySelectorAll<HTMLElement>("[data-map]")) {
      const map = Number(row.dataset.map);
      row.querySelector(".badge")?.replaceWith(badge(this.state, map));
      const picker = row.querySelector<HTMLInputElement>("input[type=color]");
      if (picker) picker.value = this.state.looks[map].color;
    }
  }

  private read(): void {
    const { cursor } = this.state;
    if (this.readings.size === 0) return;
    for (const placed of this.state.placed()) {
      const { map, T_scene_map, deformation } = placed;
      const reading = this.readings.get(map);
      if (!reading) continue;
      const grid = this.state.grids[map];
      if (!cursor || !grid) {
        reading.textContent = "–";
        continue;
      }
      const lying = apply(inverse(T_scene_map), cursor);
      // In hand it is drawn straight.
      const isBent = deformation !== undefined && map !== this.state.handled;
      const p = isBent ? straighten(deformation, lying, this.state.bent) : lying;
      // Where the cells came bent, their coordinates are none of the map's own.
      const own = placed.cameBent ? "" : `${fixed(p.x, 2)}, ${fixed(p.y, 2)} m · `;
      reading.textContent = `${own}${cellWords[grid.at(p)]}`;
    }
  }

  private list(): void {
    const { state } = this;
    const isWanted = (...maps: number[]) => !isLarge(state.report) || maps.some((map) => state.isFound(map));
    replace(this.lists,
      this.leftOut(({ map }) => isWanted(map)),
      openWays(state, state.report.open_ways.filter(({ fixed, moving }) => isWanted(fixed, moving)), this.placeSo));
  }

  private leftOut(isWanted: (one: LeftOut) => boolean): HTMLElement | null {
    const { left_out: all, maps, components } = this.state.report;
    const leftOut = all.filter(isWanted);
    if (leftOut.length === 0 || maps.length === 1) return null;
    const items = leftOut.slice(0, isLarge(this.state.report) ? mostRows : leftOut.length).map(({ map, explanation }) => focusPointsOut(h("li", { "data-map": map },
      h("div", {}, badge(this.state, map), name(this.state.names[map], maps[map].name), byHandTag()),
      h("p", { class: "soft" }, `${explanation.charAt(0).toUpperCase()}${explanation.slice(1)}.`),
      h("div", { class: "buttons" },
        h("button", { type: "button", click: () => this.showLeftOut(map) }, "Show"),
        components.length === 0 && maps.length < 2 ? null
          : h("button", { type: "button", click: () => this.placeByHand(map) }, "Place by hand"))), this.state, map));
    return h("section", { class: "left-out" },
      h("h3", {}, "Left out"),
      h("p", { class: "soft" }, "Could not be joined to another map with confidence."),
      h("ul", {}, ...items),
      moreNote(isLarge(this.state.report) ? leftOut.length : 0, "map"));
  }
}

/** Between maps as they were read and as they are merged. */
function bendRow(state: State): HTMLElement {
  const slider = h("input", {
    type: "range", id: "bent", min: 0, max: 100, step: 10, value: 100 * state.bent,
    "aria-label": "How far the maps are bent: from as they were read to as they are merged",
    input: () => state.setBent(Number(slider.value) / 100),
  });
  const arrows = h("input", { type: "checkbox", id: "arrows", change: () => state.showArrows(arrows.checked) });
  arrows.checked = state.arrows;
  return h("div", { class: "layer" },
    h("span", { class: "layer-name" }, "Bent"),
    slider,
    h("label", { class: "layer-name" }, arrows, "Arrows"),
    h("span", { class: "legend soft" }, "Left: each map straight, in its best pose. Right: bent, as it is merged. Arrows tell what moves where."));
}

function agreementCounts({ agreeing, conflicting }: Component, isMoved: boolean): string {
  const counts = `${count(agreeing, "cell")} that several maps know agree, ${conflicting} do not.`;
  return isMoved ? `As merged, not as placed by hand: ${counts}` : counts;
}

/** Of a grid that the page was not given in full; else empty. */
function coarseness({ coarser }: PackedGrid): string {
  return coarser === undefined ? "" : `Drawn in cells ${coarser} times as wide as its own. `;
}

/** The key that does the same: seen beside a name, and no part of it. */
function keyHint(key: string): HTMLElement {
  return h("kbd", { "aria-hidden": "true" }, key);
}

/** Hidden unless the map was placed by hand in the scene. */
function byHandTag(): HTMLElement {
  return h("span", { class: "by-hand", hidden: true }, "by hand");
}

function legendItem(color: Rgb, meaning: string): HTMLElement {
  return h("span", { class: "legend-item" }, swatch(rgb(color)), meaning);
}

function rgb(color: readonly number[]): string {
  return `rgb(${color.join(" ")})`;
}
