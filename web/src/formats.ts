// SPDX-License-Identifier: Apache-2.0
import { degrees, fixed } from "./numbers";
import type { Report } from "./report";
import type { SE2 } from "./se2";
import { flat } from "./text";

/** A map's pose, with the name that the map was merged under. */
export interface NamedPose {
  name: string;
  transform: SE2;
}

// Texts that hold no more than they say: names are quoted, or stripped to what a frame's name may hold.

export function asJson(frame: string, poses: NamedPose[]): string {
  const transforms = poses.map(({ name, transform }) => ({ map: name, ...plain(transform) }));
  return JSON.stringify({ frame, transforms }, null, 2) + "\n";
}

/** JSON's strings are YAML's double-quoted ones. */
export function asYaml(frame: string, poses: NamedPose[]): string {
  const lines = poses.map(({ name, transform }) => {
    const { x, y, theta } = plain(transform);
    return `  - map: ${quoted(name)}\n    x: ${x}\n    y: ${y}\n    theta: ${theta}\n`;
  });
  return `frame: ${quoted(frame)}\ntransforms:\n${lines.join("")}`;
}

/** A command for each map, for ROS 2; of several, each runs in the background, so that a shell gets to the next. */
export function asStaticTransforms(parent: string, poses: NamedPose[], children: string[]): string {
  return poses.map(({ transform }, i) => {
    const { x, y, theta } = plain(transform);
    return `ros2 run tf2_ros static_transform_publisher --x ${x} --y ${y} --yaw ${theta}` +
      ` --frame-id ${parent} --child-frame-id ${children[i]}${poses.length > 1 ? " &" : ""}\n`;
  }).join("");
}

/**
 * What the maps' frames are called below `parent`, for a name that holds {name} where each map's own id is to stand. Without it
 * several maps get theirs in front.
 */
export function childFrames(name: string, ids: string[], parent: string): string[] {
  const isEach = name.includes("{name}") || ids.length === 1;
  return ids.map((id) => {
    const child = frameName(isEach ? name.split("{name}").join(id) : `${id}/${name}`);
    return child === parent ? `${id}/${child}` : child;
  });
}

/** What TF, and a shell, can take of a frame's name that somebody typed. */
export function frameName(text: string): string {
  return text.replace(/[^A-Za-z0-9_./-]+/g, "_").replace(/^[/-]+|\/+$/g, "") || "map";
}

/** Names for TF frames, all different: file names without folder and ending where that tells maps apart. */
export function frameIds(names: string[]): string[] {
  const clean = (text: string) => text.replace(/[^A-Za-z0-9]+/g, "_").replace(/^_+|_+$/g, "") || "map";
  const whole = names.map((name) => name.replace(/\.[^./]*$/, ""));
  const short = whole.map((name) => clean(name.slice(name.lastIndexOf("/") + 1)));
  const isUnique = new Set(short).size === short.length;
  const taken = new Set<string>();
  return (isUnique ? short : whole.map(clean)).map((id) => {
    let unique = id;
    for (let i = 2; taken.has(unique); i++) unique = `${id}_${i}`;
    taken.add(unique);
    return unique;
  });
}

/** What `gridmerge merge --init` reads. Null if a name cannot be written in it. */
export function asInitialPoses(poses: { name: string; transform: SE2; sd: number; sdTheta: number }[]): string | null {
  if (poses.some(({ name }) => !isWritable(name))) return null;
  const lines = poses.map(({ name, transform, sd, sdTheta }) => {
    const { x, y, theta } = plain(transform);
    return [asArgument(name), x, y, theta, sd, sdTheta].join("\t") + "\n";
  });
  return "map\tx\ty\ttheta\tsd\tsd_theta\n" + lines.join("");
}

/**
 * The command that merges what a report shows with the file of initial poses. A node hears its robots again, whose names are no
 * files. Null if a name cannot be written in the command or the file.
 */
export function commandWith({ maps, answer }: Pick<Report, "maps" | "answer">, poses: string): string | null {
  const names = maps.map((map) => map.name);
  if (!names.every(isWritable)) return null;
  if (answer !== undefined) return `gridmerge node --init ${shellQuoted(poses)}`;
  return `gridmerge merge ${names.map((name) => shellQuoted(asArgument(name))).join(" ")} --init ${shellQuoted(poses)} -o merged_by_hand`;
}

/**
 * Tabs and line ends would break a table, other control characters and marks of direction make a command look other than it
 * is, and U+FFFD stands for bytes that are lost.
 */
function isWritable(name: string): boolean {
  return name !== "" && name === flat(name) && !name.includes("\ufffd");
}

/** Not to be taken for an option. */
function asArgument(name: string): string {
  return name.startsWith("-") ? `./${name}` : name;
}

function shellQuoted(text: string): string {
  return /^[A-Za-z0-9_.,\/+:@%-]+$/.test(text) ? text : `'${text.replace(/'/g, `'\\''`)}'`;
}

function quoted(text: string): string {
  // Line separators and control characters that JSON lets through, YAML does not.
  return JSON.stringify(text).replace(/[\u007f-\u009f\u2028\u2029\ufeff\ufffe\uffff]/g,
    (c) => "\\u" + c.charCodeAt(0).toString(16).padStart(4, "0"));
}

/** No "-0". */
function plain({ x, y, theta }: SE2): SE2 {
  return { x: x + 0, y: y + 0, theta: theta + 0 };
}

/** A pose as people read it. */
export function describe({ x, y, theta }: SE2): string {
  return `x ${fixed(x, 3)} m, y ${fixed(y, 3)} m, θ ${fixed(degrees(theta), 2)}°`;
}
