// SPDX-License-Identifier: Apache-2.0
import { mapLabel } from "./badge";
import { copyButton } from "./clipboard";
import { h, replace } from "./dom";
import { type NamedPose, asJson, asStaticTransforms, asYaml, frameIds } from "./formats";
import { degrees, fixed, probability } from "./numbers";
import type { Member } from "./report";
import type { State } from "./state";

/** Where the maps of the scene lie, to read and to copy. */
export class TransformsPanel {
  readonly element = h("div", { class: "panel", id: "panel-transforms" });
  private readonly state: State;

  constructor(state: State) {
    this.state = state;
    state.on("scene", () => this.rebuild());
    state.on("hand", () => this.rebuild());
    state.on("looks", () => this.rebuild());
    this.rebuild();
  }

  private rebuild(): void {
    const { state } = this;
    const { scene } = state;
    const rows = state.placed().map(({ map }) => this.row(map));
    replace(this.element,
      h("p", { class: "soft" }, "A transform takes a point of the map's frame to ",
        scene.component !== null && state.report.components[scene.component].frame === null
          ? scene.frame : h("span", {}, "the frame of ", h("bdi", {}, scene.frame)), ". Metres and radians."),
      h("div", { class: "table" }, h("table", {},
        h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Map"),
          ...["x [m]", "y [m]", "θ [rad]", "θ [°]", "probability", "± [m]", "± [°]"].map(
            (head) => h("th", { class: "number", scope: "col" }, head)),
          h("th", { scope: "col" }, "Copy"))),
        h("tbody", {}, ...rows))),
      h("div", { class: "buttons" }, h("span", {}, "Copy all: "), ...this.buttons(() => state.placed().map(({ map }) => map))));
  }

  private row(map: number): HTMLElement {
    const pose = this.state.poseOf(map)!;
    const member = this.memberOf(map);
    const byHand = this.state.byHand().has(map);
    const number = (text: string) => h("td", { class: "number" }, text);
    return h("tr", { "data-map": map },
      h("td", { class: "name" }, mapLabel(this.state, map), byHand ? h("em", {}, " by hand") : null),
      number(fixed(pose.x, 3)), number(fixed(pose.y, 3)), number(fixed(pose.theta, 5)), number(fixed(degrees(pose.theta), 2)),
      number(member?.probability == null || byHand ? "–" : probability(member.probability)),
      number(member?.sd && !byHand ? fixed(member.sd.position, 3) : "–"),
      number(member?.sd && !byHand ? fixed(degrees(member.sd.theta), 2) : "–"),
      h("td", { class: "buttons" }, ...this.buttons(() => [map])));
  }

  private memberOf(map: number): Member | undefined {
    const { component } = this.state.scene;
    return component === null ? undefined : this.state.report.components[component].members.find((m) => m.map === map);
  }

  private buttons(maps: () => number[]): HTMLButtonElement[] {
    const { report, scene } = this.state;
    const poses = (): NamedPose[] => maps().map((map) => ({ name: report.maps[map].name, transform: this.state.poseOf(map)! }));
    const ids = frameIds(report.maps.map((map) => map.name));
    const parent = scene.component !== null ? frameIds([scene.title])[0] : `${ids[this.state.placed()[0].map]}`;
    const children = () => maps().map((map) => (ids[map] === parent ? `${ids[map]}_map` : ids[map]));
    return [
      copyButton("YAML", () => asYaml(scene.frame, poses()), "Copy as YAML"),
      copyButton("JSON", () => asJson(scene.frame, poses()), "Copy as JSON"),
      copyButton("TF", () => asStaticTransforms(parent, poses(), children()), "Copy as static_transform_publisher commands"),
    ];
  }
}
