// SPDX-License-Identifier: Apache-2.0
import { type ChildProcess, spawn, spawnSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, rmSync, statSync } from "node:fs";
import { join } from "node:path";
import type { Report } from "../src/report";
import type { SE2 } from "../src/se2";

export const program = process.env.GRIDMERGE!;
export const source = process.env.GRIDMERGE_SOURCE!;
const work = join(source, "build/web");

/** Where pictures of the pages go, to be looked at. */
export const screenshots = join(work, "screenshots");
mkdirSync(screenshots, { recursive: true });

export const examples = [1, 2, 3].map((i) => `examples/three_robots/robot_${i}.yaml`);
export const elsewhere = "examples/three_robots/elsewhere.yaml";

/** Runs gridmerge from the project's folder; returns its exit code and what it printed. */
export function gridmerge(...args: string[]): { status: number | null; output: string } {
  const { status, stdout, stderr } = spawnSync(program, args, { cwd: source, encoding: "utf8" });
  return { status, output: stdout + stderr };
}

function must(allowed: number[], ...args: string[]): void {
  const { status, output } = gridmerge(...args);
  if (status === null || !allowed.includes(status)) throw new Error(`gridmerge ${args.join(" ")}: ${output}`);
}

/** Merges maps into a folder of that name. Returns the folder. */
export function mergeInto(name: string, maps: string[], ...options: string[]): string {
  const folder = join(work, "reports", name);
  must([0, 3], "merge", ...maps, "-o", folder, "--quiet", ...options);
  return folder;
}

/** The transforms.json of a folder. */
export function transforms(folder: string): { components: { members: { source: string; transform: SE2 }[] }[] } {
  return JSON.parse(readFileSync(join(folder, "transforms.json"), "utf8"));
}

/** What the page of a folder was given. */
export function reportData(folder: string): Report {
  const html = readFileSync(join(folder, "report.html"), "utf8");
  return JSON.parse(/id="report-data">(.*?)<\/script>/s.exec(html)![1]) as Report;
}

/** The maps of simulated robots; made once, since the same options give the same maps. */
export function simulated(name: string, robots: number, options: string[]): string[] {
  const folder = join(work, "maps", name);
  const last = join(folder, `robot_${robots}.yaml`);
  const made = existsSync(last) && statSync(last).mtimeMs > statSync(program).mtimeMs;
  if (!made) rmSync(folder, { recursive: true, force: true });
  if (!made) must([0], "simulate", "--robots", String(robots), ...options, "-o", folder, "--quiet");
  return [...Array(robots).keys()].map((i) => join(folder, `robot_${i + 1}.yaml`));
}

export const six = () => simulated("six", 6, ["--kind", "office", "--size", "50x30", "--overlap", "0.4", "--seed", "5"]);
export const eighteen = () =>
  simulated("eighteen", 18, ["--kind", "office", "--size", "60x40", "--overlap", "0.8", "--seed", "5"]);
/** Merged, they are of more than 4000 by 4000 cells. */
export const large = () =>
  simulated("large", 3, ["--kind", "office", "--size", "80x80", "--resolution", "0.02", "--overlap", "0.5", "--seed", "3"]);

/** Starts `gridmerge view` and gives the address that it prints. */
export function view(folder: string, port = 0): Promise<{ server: ChildProcess; address: string }> {
  const server = spawn(program, ["view", folder, "--port", String(port)], { cwd: source });
  return new Promise((resolve, reject) => {
    let text = "";
    server.stdout.on("data", (data: Buffer) => {
      text += data.toString();
      const address = /http:\/\/\S+/.exec(text)?.[0];
      if (address) resolve({ server, address });
    });
    server.on("exit", (code) => reject(new Error(`gridmerge view ended with ${code}: ${text}`)));
  });
}
