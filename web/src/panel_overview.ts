// SPDX-License-Identifier: Apache-2.0
import { focusPointsOut, mapLabel } from "./badge";
import { ink, white } from "./color";
import { h, replace } from "./dom";
import { Cell, type Grid } from "./grid";
import { joinTitle } from "./join_graph";
import { probability, sayDeviation, smallest } from "./numbers";
import { openWays } from "./open_ways";
import { type Component, outcomes } from "./report";
import type { SE2 } from "./se2";
import { moreNote, mostRows, searchBox } from "./search";
import type { State } from "./state";
import { count } from "./text";

const thumbnail = { width: 120, height: 80 };

interface Actions {
  /** Shows a map where it lies in what it was merged into, or by itself. */
  show(map: number): void;
  showJoin(join: number): void;
  placeSo(map: number, on: number, T_on_map: SE2): void;
}

/** Of many maps: the merged maps as tiles, a search, and all that there is to say of one map. */
export class OverviewPanel {
  readonly element = h("div", { class: "panel", id: "panel-overview" });
  private readonly state: State;
  private readonly actions: Actions;
  private readonly hits = h("div", { class: "hits" });
  private readonly chosen = h("section", { class: "one-map" });
  private readonly tiles = h("div", { class: "merged-tiles" });
  /** Of merged maps whose cells are not there yet. */
  private readonly blank = new Map<number, HTMLCanvasElement>();
  private readonly componentOf = new Map<number, number>();
  private readonly joinsOf = new Map<number, number[]>();
  private map: number | null = null;

  constructor(state: State, actions: Actions) {
    this.state = state;
    this.actions = actions;
    const { components, joins, left_out: leftOut, open_ways: ways } = state.report;
    components.forEach(({ members }, i) => members.forEach(({ map }) => this.componentOf.set(map, i)));
    joins.forEach(({ fixed: a, moving: b }, i) => [a, b].forEach((map) => {
      const known = this.joinsOf.get(map);
      if (known) known.push(i);
      else this.joinsOf.set(map, [i]);
    }));
    replace(this.element, searchBox(state), this.hits, this.chosen,
      h("h3", {}, count(components.length, "merged map")), this.tiles, moreNote(components.length, "merged map"),
      h("p", { class: "soft" }, leftOut.length === 0 ? "No map was left out." : `${count(leftOut.length, "map")} left out; Layers lists them.`),
      openWays(state, ways, actions.placeSo));
    replace(this.tiles, ...components.slice(0, mostRows).map((component, i) => this.tile(component, i)));
    state.on("query", () => this.search());
    state.on("grids", () => this.fillTiles());
  }

  /** Says all of a map. */
  choose(map: number): void {
    this.map = map;
    this.showChosen();
    this.actions.show(map);
    this.chosen.scrollIntoView({ block: "nearest" });
  }

  private tile(component: Component, index: number): HTMLElement {
    const canvas = h("canvas", { ...thumbnail, "aria-hidden": "true" });
    this.blank.set(index, canvas);
    const sure = component.members.flatMap((member) => (member.probability === null ? [] : [member.probability]));
    return h("button", {
      type: "button", class: "merged-tile", "data-component": index,
      click: () => this.state.show({ kind: "component", component: index }),
    }, canvas, h("strong", {}, component.file), h("span", {}, count(component.members.length, "map")),
    sure.length === 0 ? null : h("span", { class: "soft" }, `least sure ${probability(smallest(sure))}`));
  }

  private fillTiles(): void {
    for (const [index, canvas] of this.blank) {
      const grid = this.state.mergedGrids[index];
      if (!grid) continue;
      draw(grid, canvas);
      this.blank.delete(index);
    }
  }

  private search(): void {
    const { state } = this;
    if (state.query.trim() === "") {
      replace(this.hits);
      return;
    }
    const found = state.names.flatMap((_, map) => (state.isFound(map) ? [map] : []));
    replace(this.hits, h("ul", {}, ...found.slice(0, mostRows).map((map) => focusPointsOut(h("li", {},
      h("button", { type: "button", class: "link hit", "data-map": map, click: () => this.choose(map) }, mapLabel(state, map)),
      h("span", { class: "soft" }, this.placeOf(map))), state, map))),
    found.length === 0 ? h("p", { class: "soft" }, "No map is called so.") : moreNote(found.length, "map"));
  }

  private placeOf(map: number): string {
    const component = this.componentOf.get(map);
    return component === undefined ? "left out" : this.state.report.components[component].file;
  }

  private showChosen(): void {
    const { map, state } = this;
    if (map === null) return;
    const { components, joins, left_out: leftOut, open_ways: ways } = state.report;
    const component = this.componentOf.get(map);
    const member = component === undefined ? undefined : components[component].members.find((one) => one.map === map);
    const why = leftOut.find((one) => one.map === map);
    const own = (this.joinsOf.get(map) ?? []).sort((a, b) =>
      outcomes.indexOf(joins[a].outcome) - outcomes.indexOf(joins[b].outcome) || joins[b].probability - joins[a].probability);
    const facts = member
      ? [`In ${this.placeOf(map)}`,
        member.probability === null ? null : `probability ${probability(member.probability)}`,
        member.sd === null ? null : sayDeviation(member.sd)]
      : [`Left out: ${why?.explanation ?? ""}`];
    replace(this.chosen,
      h("h3", {}, mapLabel(state, map)),
      h("p", {}, `${facts.filter((fact) => fact !== null).join(", ")}.`),
      h("p", { class: "soft" }, `${count(own.length, "join")} of it that matter${own.length === 1 ? "s" : ""}:`),
      h("ul", { class: "own-joins" }, ...own.slice(0, mostRows).map((index) => {
        const join = joins[index];
        const other = join.fixed === map ? join.moving : join.fixed;
        return focusPointsOut(h("li", {}, h("button", {
          type: "button", class: "link", "data-join": index, title: joinTitle(state, join), click: () => this.actions.showJoin(index),
        }, mapLabel(state, other)),
        h("span", { class: `outcome ${join.outcome}` }, join.outcome), ` ${probability(join.probability)}`), state, other);
      })),
      moreNote(own.length, "join"),
      openWays(state, ways.filter((way) => way.fixed === map || way.moving === map), this.actions.placeSo));
  }
}

/** A merged map as small as a tile. */
function draw(grid: Grid, canvas: HTMLCanvasElement): void {
  const { width, height } = thumbnail;
  const context = canvas.getContext("2d")!;
  const metres = Math.max(grid.finest.width / width, grid.finest.height / height) * grid.finest.resolution;
  if (metres === 0) return;
  const level = grid.levelFor(metres);
  const pixels = new ImageData(width, height);
  const step = metres / level.resolution;
  const left = (level.width - width * step) / 2;
  const bottom = (level.height - height * step) / 2;
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const column = Math.floor(left + (x + 0.5) * step);
      const row = Math.floor(bottom + (height - y - 0.5) * step);
      if (column < 0 || row < 0 || column >= level.width || row >= level.height) continue;
      const cell = level.cells[row * level.width + column];
      if (cell !== Cell.unknown) pixels.data.set([...(cell === Cell.occupied ? ink : white), 255], 4 * (y * width + x));
    }
  }
  context.putImageData(pixels, 0, 0);
}
