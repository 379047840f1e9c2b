// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { test } from "node:test";
import { asInitialPoses, asJson, asStaticTransforms, asYaml, childFrames, commandWith, frameIds, frameName } from "../src/formats";
import { identity } from "../src/se2";
import { reportOf } from "./reports";

const hostileNames = [
  "$(touch /tmp/owned)", "`id`; rm -rf ~", "a b'c\"d", "</script><script>alert(1)</script>", "-o", "two\nlines", "tab\there",
  "\u202eover", "{}%s\\", "", "x".repeat(3000), "\u2028\u0085", "\ufffd",
];

const maps = (names: string[]) => names.map((name) => ({ ...reportOf([identity]).maps[0], name }));
const mergeCommand = (names: string[]) => commandWith({ maps: maps(names) }, "poses.tsv");

const pose = { x: 1.25, y: -3, theta: 0.1 + 0.2 };

test("JSON holds names and numbers to the bit", () => {
  const poses = hostileNames.map((name) => ({ name, transform: pose }));
  const parsed = JSON.parse(asJson("frame\n", poses)) as { frame: string; transforms: { map: string; theta: number }[] };
  assert.equal(parsed.frame, "frame\n");
  assert.deepEqual(parsed.transforms.map(({ map }) => map), hostileNames);
  assert.equal(parsed.transforms[0].theta, 0.1 + 0.2);
});

test("YAML quotes names so that none of them can be anything else", () => {
  const yaml = asYaml("the \"frame\"", hostileNames.map((name) => ({ name, transform: pose })));
  const lines = yaml.trimEnd().split("\n");
  assert.equal(lines[0], 'frame: "the \\"frame\\""');
  assert.equal(lines[1], "transforms:");
  assert.equal(lines.length, 2 + 4 * hostileNames.length);
  hostileNames.forEach((name, i) => {
    const [map, x, y, theta] = lines.slice(2 + 4 * i, 6 + 4 * i);
    assert.ok(map.startsWith('  - map: "') && map.endsWith('"'));
    assert.ok(!/[\u0000-\u001f\u007f-\u009f\u2028\u2029]/.test(map));
    assert.equal(JSON.parse(map.slice("  - map: ".length)), name);
    assert.deepEqual([x, y, theta], ["    x: 1.25", "    y: -3", "    theta: 0.30000000000000004"]);
  });
});

test("no number is written as -0", () => {
  assert.ok(!asYaml("a", [{ name: "b", transform: { x: -0, y: -0, theta: -0 } }]).includes("-0"));
});

test("static transforms hold nothing but what frames may be called", () => {
  const ids = frameIds(hostileNames);
  assert.equal(new Set(ids).size, hostileNames.length);
  for (const id of ids) assert.match(id, /^[A-Za-z0-9_]+$/);
  const text = asStaticTransforms("merged", hostileNames.map((name) => ({ name, transform: pose })), ids);
  for (const line of text.trimEnd().split("\n")) {
    assert.match(line, /^ros2 run tf2_ros static_transform_publisher --x 1\.25 --y -3 --yaw 0\.30000000000000004 --frame-id merged --child-frame-id [A-Za-z0-9_]+ &$/);
  }
  assert.ok(!asStaticTransforms("merged", [{ name: "a", transform: pose }], ["a"]).includes("&"), "one runs in the foreground");
});

test("frames are named after files, with the folder where that tells maps apart", () => {
  assert.deepEqual(frameIds(["maps/robot_1.yaml", "maps/robot-2.yaml"]), ["robot_1", "robot_2"]);
  assert.deepEqual(frameIds(["a/map.yaml", "b/map.yaml"]), ["a_map", "b_map"]);
  assert.deepEqual(frameIds(["a-b.yaml", "a b.yaml"]), ["a_b", "a_b_2"]);
  assert.deepEqual(frameIds(["merged.yaml", "m/merged.yaml"]), ["merged", "m_merged"]);
});

test("frames are called as somebody asks", () => {
  const ids = ["robot_1", "robot_2"];
  assert.deepEqual(childFrames("{name}", ids, "map"), ids);
  assert.deepEqual(childFrames("{name}/map", ids, "map"), ["robot_1/map", "robot_2/map"]);
  assert.deepEqual(childFrames("tb1/map", ["robot_1"], "map"), ["tb1/map"]);
  assert.deepEqual(childFrames("map", ids, "map"), ["robot_1/map", "robot_2/map"], "no two frames have one name");
  assert.deepEqual(childFrames("map", ["robot_1"], "map"), ["robot_1/map"]);
  assert.equal(frameName(""), "map");
  assert.equal(frameName("/tb1/map"), "tb1/map");
  for (const name of hostileNames) assert.match(frameName(name), /^[A-Za-z0-9_.][A-Za-z0-9_./-]*$/);
});

test("a shell reads back every name that the merge command holds", () => {
  const names = hostileNames.filter((name) => mergeCommand([name]) !== null);
  assert.ok(names.length >= 6);
  const command = mergeCommand(names)!;
  const read = execFileSync("/bin/sh", ["-c", command.replace("gridmerge merge", "printf '%s\\n'")], { encoding: "utf8" });
  const expected = [...names.map((name) => (name === "-o" ? "./-o" : name)), "--init", "poses.tsv", "-o", "merged_by_hand"];
  assert.deepEqual(read.trimEnd().split("\n"), expected);
});

test("a node is started anew with the poses: its robots are no files", () => {
  assert.equal(commandWith({ maps: maps(["tb1", "tb2"]), answer: 0 }, "poses.tsv"), "gridmerge node --init poses.tsv");
  assert.equal(commandWith({ maps: maps(["tb1", "two\nlines"]), answer: 3 }, "poses.tsv"), null);
});

test("names that a table cannot hold are not written", () => {
  for (const name of ["two\nlines", "tab\there", "", "\ufffd", "\u0000", "\u202eover", "\u0085", "\u2066"]) {
    assert.equal(asInitialPoses([{ name, transform: pose, sd: 1, sdTheta: 0.1 }]), null);
    assert.equal(mergeCommand(["a.yaml", name]), null);
  }
});

test("a table of initial poses names its columns", () => {
  assert.match(asInitialPoses([{ name: "-o", transform: pose, sd: 1, sdTheta: 1 }])!, /^\.\/-o\t/m, "as in the command");
  assert.equal(asInitialPoses([{ name: "a b.yaml", transform: pose, sd: 0.3, sdTheta: 0.05 }]),
    "map\tx\ty\ttheta\tsd\tsd_theta\na b.yaml\t1.25\t-3\t0.30000000000000004\t0.3\t0.05\n");
});
