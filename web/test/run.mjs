// SPDX-License-Identifier: Apache-2.0
// Bundles the tests and runs them with Node's own test runner.
import { spawnSync } from "node:child_process";
import { mkdirSync, readdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const out = join(here, "../../build/web/test");
mkdirSync(out, { recursive: true });
const tests = readdirSync(here).filter((name) => name.endsWith(".test.ts"));

function run(program, ...args) {
  const { status, error } = spawnSync(program, args, { stdio: "inherit", timeout: 300000 });
  if (error) console.error(`${program}: ${error.message}`);
  if (status !== 0) process.exit(status ?? 1);
}

run("esbuild", ...tests.map((name) => join(here, name)), "--bundle", "--platform=node", "--format=esm", "--log-level=warning",
  "--out-extension:.js=.mjs", `--outdir=${out}`);
run(process.execPath, "--test", ...tests.map((name) => join(out, name.replace(/\.ts$/, ".mjs"))));
