// SPDX-License-Identifier: Apache-2.0
import { focusPointsOut, mapLabel } from "./badge";
import { copyButton } from "./clipboard";
import type { Shape } from "./deformation";
import { h, replace } from "./dom";
import { type NamedPose, asJson, asStaticTransforms, asYaml, childFrames, frameIds, frameName } from "./formats";
import { degrees, fixed, probability, sayDeviation } from "./numbers";
import { type Member, isLarge } from "./report";
import { moreNote, mostRows, searchBox } from "./search";
import type { State } from "./state";
import { flat } from "./text";

/** Of a frame that is no map's. */
function otherFrame(state: State): HTMLElement {
  const { plan } = state.report;
  return plan === undefined ? h("strong", {}, "in which poses were given") : h("span", {}, "of the plan ", h("strong", {}, h("bdi", {}, plan.name)));
}

/** What is done to a map before its transform places it. */
const shapeWords: Record<Shape["kind"], (shape: Shape) => string> = {
  similarity: ({ scale }) => `scaled by ${fixed(scale!, 4)} first`,
  affine: ({ scale }) => `scaled by ${fixed(scale!, 4)} and sheared first`,
  elastic: () => "bent first",
};

/** Where the maps of the scene lie, to read and to copy. */
export class TransformsPanel {
  readonly element = h("div", { class: "panel", id: "panel-transforms" });
  private readonly state: State;
  /** Apart from the search, which keeps the focus while what it found changes. */
  private readonly content: HTMLElement;
  private pending = 0;
  /** How frames are called in TF: that of the scene as map servers do, and each map's. */
  private readonly parent = h("input", { type: "text", id: "tf-parent", "data-kept": true, value: "map", spellcheck: "false" });
  private readonly child = h("input", { type: "text", id: "tf-child", "data-kept": true, value: "{name}", spellcheck: "false" });

  constructor(state: State) {
    this.state = state;
    state.on("scene", () => this.rebuild());
    state.on("hand", () => this.rebuild());
    for (const topic of ["colors", "query"] as const) state.on(topic, () => this.rebuild());
    this.content = isLarge(state.report) ? h("div") : this.element;
    if (this.content !== this.element) replace(this.element, searchBox(state), this.content);
    this.rebuild();
  }

  private rebuild(): void {
    if (this.pending !== 0) return;
    // Once a frame is enough while a map is dragged.
    this.pending = requestAnimationFrame(() => {
      this.pending = 0;
      this.draw();
    });
  }

  private draw(): void {
    const { state } = this;
    const { scene } = state;
    const large = isLarge(state.report);
    const maps = state.placed().map(({ map }) => map).filter((map) => !large || state.isFound(map));
    const rows = (large ? maps.slice(0, mostRows) : maps).flatMap((map) => this.rows(map));
    replace(this.content,
      h("p", { class: "frame" }, "In the frame ",
        scene.frame === null ? otherFrame(state) : h("span", {}, "of ", h("strong", {}, mapLabel(state, scene.frame))),
        scene.component === null ? "." : h("span", {}, ", which is also that of ", h("bdi", {}, scene.title), "."),
        h("span", { class: "soft" }, " A transform takes a point of the map's own frame there.")),
      h("div", { class: "table" }, h("table", {},
        h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Map"),
          ...["x [m]", "y [m]", "θ [rad]"].map((head) => h("th", { class: "number", scope: "col" }, head)))),
        h("tbody", {}, ...rows))),
      moreNote(large ? maps.length : 0, "map"),
      h("div", { class: "buttons copying" }, h("span", {}, "Copy all:"), ...this.buttons("all transforms", () => state.placed().map(({ map }) => map))),
      h("div", { class: "pose-inputs copying", title: "The frames of TF commands. {name} is the map's file without its ending" },
        h("label", {}, "TF from ", this.parent), h("label", {}, "to ", this.child)));
  }

  /** One with the pose, one with how sure it is. */
  private rows(map: number): HTMLElement[] {
    const pose = this.state.poseOf(map)!;
    const byHand = this.state.byHand().has(map);
    const number = (text: string) => h("td", { class: "number" }, text);
    return [
      h("tr", { class: "pose", "data-map": map },
        h("td", { class: "name" }, mapLabel(this.state, map)),
        number(fixed(pose.x, 3)), number(fixed(pose.y, 3)), number(fixed(pose.theta, 5))),
      focusPointsOut(h("tr", { class: "more" }, h("td", { colspan: 4 }, h("div", { class: "buttons" },
        ...this.buttons(flat(this.state.names[map]), () => [map]),
        h("span", { class: "soft" }, `${fixed(degrees(pose.theta), 2)}°`, byHand ? ", placed by hand" : this.certainty(map))))), this.state, map),
    ];
  }

  private memberOf(map: number): Member | undefined {
    const { component } = this.state.scene;
    return component === null ? undefined : this.state.report.components[component].members.find((m) => m.map === map);
  }

  private certainty(map: number): string {
    const member = this.memberOf(map);
    const parts: string[] = [];
    const shape = member?.deformation ?? member?.shape;
    if (shape) parts.push(shapeWords[shape.kind](shape));
    if (member?.probability != null) parts.push(`probability ${probability(member.probability)}`);
    if (map === this.state.scene.frame) parts.push("holds the frame");
    else if (member?.sd) parts.push(sayDeviation(member.sd));
    return parts.map((part) => `, ${part}`).join("");
  }

  private buttons(whose: string, maps: () => number[]): HTMLButtonElement[] {
    const { report, scene } = this.state;
    const poses = (): NamedPose[] => maps().map((map) => ({ name: report.maps[map].name, transform: this.state.poseOf(map)! }));
    const frame = scene.frame === null ? report.plan?.name ?? "world" : report.maps[scene.frame].name;
    const staticTransforms = (): string => {
      const parent = frameName(this.parent.value);
      // The frame that all are in is one more, whatever maps are called.
      const [, ...ids] = frameIds([parent, ...report.maps.map((map) => map.name)]);
      return asStaticTransforms(parent, poses(), childFrames(this.child.value, maps().map((map) => ids[map]), parent));
    };
    return [
      copyButton("YAML", () => asYaml(frame, poses()), `Copy ${whose} as YAML`),
      copyButton("JSON", () => asJson(frame, poses()), `Copy ${whose} as JSON`),
      copyButton("TF", staticTransforms, `Copy ${whose} as TF, for static_transform_publisher`),
    ];
  }
}
