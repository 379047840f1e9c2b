// SPDX-License-Identifier: Apache-2.0
import { watchReader } from "./at_work";
import { announce, download } from "./clipboard";
import { h, replace } from "./dom";
import { Following } from "./follow";
import { type Grid, unpack } from "./grid";
import { helpDialog } from "./help";
import { type Icon, icon } from "./icons";
import { fixed } from "./numbers";
import { HandPanel } from "./panel_hand";
import { JoinsPanel } from "./panel_joins";
import { LayersPanel } from "./panel_layers";
import { OverviewPanel } from "./panel_overview";
import { PageMemory } from "./page_memory";
import { TransformsPanel } from "./panel_transforms";
import { type PackedGrid, type Report, expandRefused, heading, isLarge, pageTitle, summary } from "./report";
import { describeRuler } from "./ruler";
import { type SceneId, firstScene } from "./scene";
import { type SE2, compose } from "./se2";
import { SharedState } from "./shared_state";
import { Stage } from "./stage";
import { StageInput } from "./stage_input";
import { State } from "./state";
import { Tabs } from "./tabs";
import { count, flat } from "./text";

/** The scenes that can be picked without a join: merged maps and maps that were left out. */
function scenePicker(state: State): HTMLElement {
  const { report } = state;
  const { components, left_out: leftOut } = report;
  const ids: { id: SceneId; label: string }[] = [
    ...components.map((component, i) => ({
      id: { kind: "component", component: i } as SceneId,
      label: `${component.file} (${count(component.members.length, "map")})`,
    })),
    ...leftOut.map(({ map }) => ({ id: { kind: "map", map } as SceneId, label: `${report.maps.length > 1 ? "left out: " : ""}${flat(state.names[map])}` })),
  ];
  const select = h("select", { id: "scene", change: () => {
    if (select.value !== "") state.show(ids[Number(select.value)].id);
  } }, ...ids.map(({ label }, i) => h("option", { value: i }, label)));
  const join = h("option", { value: "", hidden: true }, "");
  select.append(join);
  const follow = () => {
    const current = ids.findIndex(({ id }) => JSON.stringify(id) === JSON.stringify(state.scene.id));
    join.textContent = `join: ${flat(state.scene.title)}`;
    join.hidden = current >= 0;
    select.value = current < 0 ? "" : String(current);
  };
  state.on("scene", follow);
  follow();
  return h("label", { class: "scene-picker" }, "Showing ", select);
}

/** The maps over each other, or what they were merged into: one click from everywhere. */
function mergedSwitch(state: State, toggle: () => void): HTMLElement | null {
  if (state.report.components.length === 0) return null;
  const button = (label: string, isMerged: boolean) => h("button", {
    type: "button", "data-merged": String(isMerged), click: () => {
      if (isShown() !== isMerged) toggle();
    },
  }, label);
  const buttons = [button("Maps", false), button("Merged map", true)];
  const isShown = () => state.merged.visible && state.scene.component !== null;
  const follow = () => buttons.forEach((one, i) => one.setAttribute("aria-pressed", String(isShown() === (i === 1))));
  for (const topic of ["looks", "scene"] as const) state.on(topic, follow);
  follow();
  return h("div", { class: "segments", role: "group", "aria-label": "What is drawn" }, ...buttons);
}

/** Says that maps do not lie as they were merged; over the maps, since in the head it would shift them while one is dragged. */
function byHandNote(state: State): HTMLElement {
  const element = h("div", { class: "measured", id: "by-hand-note" });
  const follow = () => {
    const moved = state.byHand().size;
    element.textContent = moved === 0 ? "" : `${count(moved, "map")} ${moved === 1 ? "is" : "are"} shown as placed by hand`;
  };
  for (const topic of ["hand", "scene"] as const) state.on(topic, follow);
  return element;
}

/** Where the cursor is. It is read out where the keyboard moves it, once it rests: a mouse moves it a hundred times a second. */
function cursorReading(state: State, stage: Stage): HTMLElement {
  const element = h("output", { class: "cursor", id: "cursor", "aria-live": "off" });
  let timer: ReturnType<typeof setTimeout> | undefined;
  state.on("cursor", () => {
    const { cursor } = state;
    element.textContent = cursor ? `x ${fixed(cursor.x, 2)} m, y ${fixed(cursor.y, 2)} m` : "";
    clearTimeout(timer);
    if (cursor && stage.crosshair) timer = setTimeout(() => announce(element.textContent!), rest);
  });
  return element;
}

function rulerReading(state: State): HTMLElement {
  const element = h("output", { class: "measured", id: "measured" });
  state.on("ruler", () => {
    element.textContent = state.ruler ? describeRuler(state.ruler) : "";
  });
  return element;
}

interface StageActions {
  toggleRuler(): void;
  savePicture(): void;
  copyLink(): void;
  help(): void;
}

function stageButtons(stage: Stage, state: State, actions: StageActions): HTMLElement {
  const button = (label: string, picture: Icon, click: () => void) =>
    h("button", { type: "button", "aria-label": label, title: label, click }, icon(picture));
  const ruler = button("Measure", "ruler", actions.toggleRuler);
  ruler.setAttribute("aria-pressed", "false");
  state.on("ruler", () => {
    ruler.setAttribute("aria-pressed", String(state.ruler !== null));
    stage.canvas.classList.toggle("measuring", state.ruler !== null);
  });
  const grid = button("Metre grid", "grid", () => stage.toggleGrid());
  const tellGrid = () => grid.setAttribute("aria-pressed", String(stage.gridShown));
  state.on("metres", tellGrid);
  tellGrid();
  return h("div", { class: "stage-buttons" },
    button("Zoom in", "plus", () => stage.zoom(1.5)),
    button("Zoom out", "minus", () => stage.zoom(1 / 1.5)),
    button("Show all", "all", () => stage.fit()),
    grid,
    ruler,
    button("Save what is seen as a PNG", "picture", actions.savePicture),
    button("Copy a link to this view", "link", actions.copyLink),
    button("Keys", "help", actions.help));
}

/** Says what was done, for a moment. */
function notice(): { element: HTMLElement; say(text: string): void } {
  const element = h("div", { class: "notice", "aria-hidden": "true" });
  let timer: ReturnType<typeof setTimeout> | undefined;
  return {
    element,
    say: (text) => {
      announce(text);
      element.textContent = text;
      clearTimeout(timer);
      timer = setTimeout(() => (element.textContent = ""), 2500);
    },
  };
}

/**
 * The grids, those that are seen first first; what they were unpacked from is let go. Of many maps the merged ones come first,
 * and the page is ready with them; the others follow, those that are asked for meanwhile first.
 */
async function unpackAll(state: State): Promise<void> {
  const { report } = state;
  const large = isLarge(report);
  const damaged: string[] = [];
  let due = 0;
  const each = async (name: string, packed: PackedGrid, keep: (grid: Grid) => void) => {
    try {
      keep(await unpack(packed));
    } catch (error) {
      damaged.push(`${name} (${error instanceof Error ? error.message : String(error)})`);
    }
    packed.cells = "";
    // Of many maps not after each: what listens would take longer than unpacking.
    if (performance.now() < due) return;
    if (large) due = performance.now() + pause;
    state.changed("grids");
  };
  const unpackMap = (i: number) => each(report.maps[i].name, report.maps[i], (grid) => { state.grids[i] = grid; });
  const unpackMerged = async () => {
    for (const [i, component] of report.components.entries()) {
      await each(component.file, component, (grid) => { state.mergedGrids[i] = grid; });
    }
  };
  const unpackPlan = async () => {
    const { plan } = report;
    if (plan?.grid) await each(plan.name, plan.grid, (grid) => { state.planGrid = grid; });
  };
  const first = new Set(state.scene.placed.map(({ map }) => map));
  const waiting = new Set([...report.maps.keys()].sort((a, b) => Number(first.has(b)) - Number(first.has(a))));
  if (!large) {
    for (const i of waiting) await unpackMap(i);
    await unpackMerged();
    await unpackPlan();
  } else {
    await unpackMerged();
    await unpackPlan();
    state.changed("grids");
    document.documentElement.dataset.ready = "true";
    while (waiting.size > 0) {
      const next = state.wanted.filter((map) => waiting.has(map)).concat([...waiting]).slice(0, atOnce);
      for (const map of next) waiting.delete(map);
      if (next.some((map) => state.wanted.includes(map))) due = 0;
      await Promise.all([...new Set(next)].map(unpackMap));
      await new Promise((done) => setTimeout(done));
    }
    state.changed("grids");
    document.documentElement.dataset.all = "true";
  }
  if (damaged.length > 0) showProblem(`The data of these maps are damaged: ${damaged.join(", ")}`);
  document.documentElement.dataset.ready = "true";
}

/** So many maps are unpacked at once, if there are many. */
const atOnce = 8;

/** Between redrawings while many maps are unpacked [ms]. */
const pause = 300;

/** A cursor that stands still for so long rests [ms]. */
const rest = 500;

function showProblem(text: string): void {
  document.getElementById("problem")!.textContent = text;
}

function build(report: Report): void {
  const state = new State(report);
  const stage = new Stage(state);
  const help = helpDialog();
  const said = notice();
  const hand = new HandPanel(state, () => stage.view.center);
  const take = (map: number) => {
    tabs.select("hand");
    hand.take(map);
    stage.fit();
    stage.canvas.focus();
  };
  const placeSo = (map: number, on: number, T_on_map: SE2) => {
    state.show(sceneOf(report, on));
    const T_scene_map = compose(state.poseOf(on)!, T_on_map);
    take(map);
    state.put(map, T_scene_map);
    stage.fit();
  };
  const layers = new LayersPanel(state, {
    show: (map) => state.show({ kind: "map", map }),
    placeByHand: (map) => {
      if (state.scene.id.kind !== "component") state.show(baseFor(report, map));
      take(map);
    },
    placeSo,
  });
  const joins = new JoinsPanel(state, { placeByHand: placeSo });
  const overview = () => new OverviewPanel(state, {
    show: (map) => {
      state.wanted = [map];
      state.show(sceneOf(report, map));
      state.choose(map);
      stage.lookAtMap(map);
    },
    showJoin: (join) => {
      tabs.select("joins");
      joins.goTo(join);
      joins.focus();
    },
    placeSo,
  });
  const transforms = new TransformsPanel(state);
  const tabs = new Tabs([
    ...(isLarge(report) ? [{ id: "overview", label: "Overview", panel: overview().element }] : []),
    { id: "layers", label: "Layers", panel: layers.element },
    { id: "joins", label: "Joins", panel: joins.element },
    { id: "transforms", label: "Transforms", panel: transforms.element },
    { id: "hand", label: "By hand", panel: hand.element },
  ], (id) => {
    if (id !== "hand" && state.handled !== null) state.letGo();
  });
  const toggleMerged = () => {
    if (state.scene.component === null) {
      // What is seen has no merged map: the one that was seen last, or else the first.
      state.merged.visible = false;
      state.show(state.whole.kind === "component" ? state.whole : firstScene(report));
    }
    layers.toggle(state.merged);
  };
  const toggleRuler = () => {
    state.measure(state.ruler ? null : { from: null, to: null, open: false });
    stage.canvas.focus();
  };
  const shared = new SharedState(state, stage, tabs);
  const actions: StageActions = {
    toggleRuler,
    savePicture: () => void stage.picture().then((png) => {
      if (png) download(`${fileNameOf(state.scene.title)}.png`, png);
      said.say(png ? "Picture saved" : "The browser could not make a picture");
    }),
    copyLink: () => void shared.copyLink().then((copied) => said.say(copied ? "Link copied" : "The link is in the address bar")),
    help: () => help.showModal(),
  };
  // What a key has done cannot be heard from the box or the button that it stands for.
  const tell = (what: string, isShown: boolean) => announce(`${what} ${isShown ? "shown" : "hidden"}`);
  new StageInput(stage, state, {
    toggleMap: (map) => {
      if (!state.poseOf(map)) return;
      layers.toggle(state.looks[map]);
      tell(flat(state.names[map]), state.looks[map].visible);
    },
    toggleMerged: () => {
      if (report.components.length === 0) return;
      toggleMerged();
      tell("Merged map", state.merged.visible);
    },
    toggleAgreement: () => {
      if (state.placed().length < 2) return;
      layers.toggle(state.agreement);
      tell("Agreement", state.agreement.visible);
    },
    togglePlan: () => {
      if (!state.planPlace()) return;
      layers.toggle(state.plan);
      tell("Plan", state.plan.visible);
    },
    toggleGrid: () => {
      stage.toggleGrid();
      tell("Metre grid", stage.gridShown);
    },
    toggleRuler: () => {
      toggleRuler();
      tell("Ruler", state.ruler !== null);
    },
    help: () => help.showModal(),
    refine: () => void hand.refine(),
  });
  const isAtWork = watchReader(state, stage.canvas);
  const following: Following | null = report.answer === undefined ? null : new Following(report.answer, () => isAtWork() || !memory.isSafe());
  replace(document.getElementById("app")!,
    shared.note,
    h("header", {},
      h("h1", {}, heading(report)), h("p", { id: "summary" }, summary(report)), following?.element ?? null, mergedSwitch(state, toggleMerged), scenePicker(state)),
    h("main", {},
      h("div", { class: "stage" }, stageButtons(stage, state, actions), stage.canvas, said.element,
        h("div", { class: "readings" }, byHandNote(state), rulerReading(state), cursorReading(state, stage))),
      h("aside", {}, tabs.element)),
    help);
  document.title = pageTitle(report);
  const memory: PageMemory = new PageMemory(state, {
    shared,
    take: (map) => hand.take(map),
    get sorting() {
      return joins.table.sortedBy;
    },
    set sorting(sorting) {
      joins.table.sortBy(sorting);
    },
    get paused() {
      return following?.paused ?? false;
    },
    set paused(isPaused) {
      following?.pause(isPaused);
    },
  });
  if (!memory.restore()) shared.restore(location.hash);
  window.addEventListener("hashchange", () => shared.restore(location.hash));
  void unpackAll(state);
}

/** A title as a file may be called. */
function fileNameOf(title: string): string {
  return title.replace(/\.(yaml|yml)$/, "").replace(/[^A-Za-z0-9_.-]+/g, "_").replace(/^[._]+/, "") || "map";
}

/** The merged map that a map is part of, or else the map by itself. */
function sceneOf(report: Report, map: number): SceneId {
  const component = report.components.findIndex(({ members }) => members.some((member) => member.map === map));
  return component < 0 ? { kind: "map", map } : { kind: "component", component };
}

/** On what a map that was left out can be placed: the first merged map, or else another map. */
function baseFor(report: Report, map: number): SceneId {
  const first = firstScene(report);
  return first.kind === "map" && first.map === map ? { kind: "map", map: map === 0 ? 1 : 0 } : first;
}

try {
  const data = document.getElementById("report-data")!;
  const report = JSON.parse(data.textContent!) as Report;
  expandRefused(report);
  data.textContent = "";
  build(report);
} catch (error) {
  showProblem(`This report cannot be shown: ${error instanceof Error ? error.message : String(error)}`);
}
