// SPDX-License-Identifier: Apache-2.0
// Bundles one of the files here and runs it: node run.mjs all | figures, with GRIDMERGE naming the program.
import { spawnSync } from "node:child_process";
import { mkdirSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const web = dirname(here);
const out = join(web, "../build/web");
mkdirSync(out, { recursive: true });
const [which = "all"] = process.argv.slice(2);
// One test, by a part of its name, while working on it.
const only = process.env.ONLY ? [`--test-name-pattern=${process.env.ONLY}`] : [];
const bundle = join(out, `${which}.cjs`);
const env = {
  ...process.env,
  NODE_PATH: join(web, "node_modules"),
  GRIDMERGE: resolve(process.env.GRIDMERGE ?? join(web, "../build/release/bin/gridmerge")),
  GRIDMERGE_SOURCE: dirname(web),
};

function run(program, ...args) {
  const { status, error } = spawnSync(program, args, { stdio: "inherit", env, timeout: 900000 });
  if (error) console.error(`${program}: ${error.message}`);
  if (status !== 0) process.exit(status ?? 1);
}

run("esbuild", join(here, `${which}.ts`), "--bundle", "--platform=node", "--format=cjs", "--external:playwright-core",
  "--log-level=warning", `--outfile=${bundle}`);
if (which === "figures") run(process.execPath, bundle);
else run(process.execPath, "--test", ...only, bundle);
