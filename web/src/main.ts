// SPDX-License-Identifier: Apache-2.0
import { h, replace } from "./dom";
import { unpack } from "./grid";
import { helpDialog } from "./help";
import { fixed } from "./numbers";
import { HandPanel } from "./panel_hand";
import { JoinsPanel } from "./panel_joins";
import { LayersPanel } from "./panel_layers";
import { TransformsPanel } from "./panel_transforms";
import { type Report, count, summary } from "./report";
import { type SceneId, firstScene } from "./scene";
import { Stage } from "./stage";
import { StageInput } from "./stage_input";
import { State } from "./state";
import { Tabs } from "./tabs";

/** The scenes that can be picked without a join: merged maps and maps that were left out. */
function scenePicker(state: State): HTMLElement {
  const { components, left_out: leftOut } = state.report;
  const ids: { id: SceneId; label: string }[] = [
    ...components.map((component, i) => ({
      id: { kind: "component", component: i } as SceneId,
      label: `${component.file} (${count(component.members.length, "map")})`,
    })),
    ...leftOut.map(({ map }) => ({ id: { kind: "map", map } as SceneId, label: `left out: ${state.names[map]}` })),
  ];
  const select = h("select", { id: "scene", change: () => {
    if (select.value !== "") state.show(ids[Number(select.value)].id);
  } }, ...ids.map(({ label }, i) => h("option", { value: i }, label)));
  const join = h("option", { value: "", hidden: true }, "");
  select.append(join);
  const follow = () => {
    const current = ids.findIndex(({ id }) => JSON.stringify(id) === JSON.stringify(state.scene.id));
    join.textContent = `join: ${state.scene.title}`;
    join.hidden = current >= 0;
    select.value = current < 0 ? "" : String(current);
  };
  state.on("scene", follow);
  follow();
  return h("label", { class: "scene-picker" }, "Showing ", select);
}

function cursorReading(state: State): HTMLElement {
  const element = h("output", { class: "cursor", id: "cursor" });
  state.on("cursor", () => {
    const { cursor } = state;
    element.textContent = cursor ? `x ${fixed(cursor.x, 2)} m, y ${fixed(cursor.y, 2)} m` : "";
  });
  return element;
}

function stageButtons(stage: Stage, help: HTMLDialogElement): HTMLElement {
  const button = (label: string, text: string, click: () => void) =>
    h("button", { type: "button", "aria-label": label, title: label, click }, text);
  return h("div", { class: "stage-buttons" },
    button("Zoom in", "+", () => stage.zoom(1.5)),
    button("Zoom out", "−", () => stage.zoom(1 / 1.5)),
    button("Show all", "⤢", () => stage.fit()),
    button("Metre grid", "#", () => {
      stage.gridShown = !stage.gridShown;
      stage.redraw();
    }),
    button("Keys", "?", () => help.showModal()));
}

/** The grids one after the other, the one that is seen first first, so that something is seen soon. */
async function unpackAll(state: State): Promise<void> {
  const { report } = state;
  const damaged: string[] = [];
  const each = async (name: string, work: () => Promise<void>) => {
    try {
      await work();
      state.changed("grids");
    } catch (error) {
      damaged.push(`${name} (${error instanceof Error ? error.message : String(error)})`);
    }
  };
  const first = new Set(state.scene.placed.map(({ map }) => map));
  const order = [...report.maps.keys()].sort((a, b) => Number(first.has(b)) - Number(first.has(a)));
  for (const i of order) {
    await each(report.maps[i].name, async () => { state.grids[i] = await unpack(report.maps[i]); });
  }
  for (const [i, component] of report.components.entries()) {
    await each(component.file, async () => { state.mergedGrids[i] = await unpack(component); });
  }
  if (damaged.length > 0) showProblem(`The data of these maps are damaged: ${damaged.join(", ")}`);
  document.documentElement.dataset.ready = "true";
}

function showProblem(text: string): void {
  document.getElementById("problem")!.textContent = text;
}

function build(report: Report): void {
  const state = new State(report);
  const stage = new Stage(state);
  const help = helpDialog();
  const hand = new HandPanel(state, () => stage.view.center);
  const layers = new LayersPanel(state, {
    show: (map) => state.show({ kind: "map", map }),
    placeByHand: (map) => {
      if (state.scene.id.kind !== "component") state.show(baseFor(report, map));
      tabs.select("hand");
      hand.take(map);
      stage.fit();
    },
  });
  const joins = new JoinsPanel(state);
  const transforms = new TransformsPanel(state);
  const tabs = new Tabs([
    { id: "layers", label: "Layers", panel: layers.element },
    { id: "joins", label: "Joins", panel: joins.element },
    { id: "transforms", label: "Transforms", panel: transforms.element },
    { id: "hand", label: "By hand", panel: hand.element },
  ], (id) => {
    if (id !== "hand" && state.handled !== null) state.take(null);
  });
  new StageInput(stage, state, {
    toggleMap: (index) => layers.toggleNth(index),
    toggleMerged: () => layers.toggle(state.merged),
    toggleAgreement: () => layers.toggle(state.agreement),
    help: () => help.showModal(),
    refine: () => void hand.refine(),
  });
  replace(document.getElementById("app")!,
    h("header", {},
      h("h1", {}, "Merged maps"), h("p", { id: "summary" }, summary(report)), scenePicker(state)),
    h("main", {},
      h("div", { class: "stage" }, stage.canvas, stageButtons(stage, help), cursorReading(state)),
      h("aside", {}, tabs.element)),
    help);
  void unpackAll(state);
}

/** On what a map that was left out can be placed: the first merged map, or else another map. */
function baseFor(report: Report, map: number): SceneId {
  const first = firstScene(report);
  return first.kind === "map" && first.map === map ? { kind: "map", map: map === 0 ? 1 : 0 } : first;
}

try {
  build(JSON.parse(document.getElementById("report-data")!.textContent!) as Report);
} catch (error) {
  showProblem(`This report cannot be shown: ${error instanceof Error ? error.message : String(error)}`);
}
