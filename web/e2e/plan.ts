// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { test } from "node:test";
import { lastCopied, open } from "./browser";
import { elsewhere, examples, mergeInto, reportData, view } from "./reports";

/** What the robots map together, at another scale. */
function plan(): string {
  const folder = mergeInto("three", examples);
  const file = `${folder}/plan.yaml`;
  writeFileSync(file, readFileSync(`${folder}/merged.yaml`, "utf8").replace(/resolution: (\S+)/, (_, metres) => `resolution: ${0.8 * Number(metres)}`));
  return file;
}

const planned = () => mergeInto("planned", examples, "--plan", plan(), "--plan-scale", "1.15:1.35");

test("a plan is drawn under the maps that hang on it", async () => {
  const folder = planned();
  const data = reportData(folder);
  assert.deepEqual(data.plan!.maps, [0, 1, 2]);
  const tab = await open(folder);
  const { page } = tab;
  assert.ok(await page.isChecked("#layer-plan"));
  assert.match((await page.textContent(".layer:has(#layer-plan)"))!, /plan\.yaml, enlarged by 1\.2\d+\. *$/);
  await tab.screenshot("plan");
  const shown = await tab.picture();
  assert.ok(await tab.changes(() => page.click("#layer-plan")), "it can be hidden");
  await page.focus("canvas");
  await page.keyboard.press("p");
  assert.ok(await page.isChecked("#layer-plan"), "its key shows it again");
  await page.focus("#layer-plan");
  assert.equal(await tab.picture(), shown);
  assert.ok(await tab.changes(() => page.fill("input[aria-label='How strongly Plan is drawn']", "30")));
  await page.click("button[aria-label^='Copy a link']");
  const link = await lastCopied(page);
  assert.match(link, /plan=0\.3/);
  const faded = await tab.picture();
  const other = await open(link);
  await other.page.focus("#layer-plan");
  assert.equal(await other.picture(), faded);
  await other.close();
  assert.ok(await tab.changes(() => page.click("button[data-merged='true']")));
  await tab.screenshot("plan_merged");
  assert.ok(await tab.changes(() => page.click("#layer-plan")), "it is seen beside the merged map as well");
  await page.click("#tab-joins");
  await page.locator("button[data-join]").first().click();
  await page.click("#tab-layers");
  assert.equal(await page.locator("#layer-plan").count(), 0, "two maps alone lie in no plan's frame");
  await tab.close();
});

test("a single map is seen on its plan", async () => {
  const tab = await open(mergeInto("one_planned", examples.slice(0, 1), "--plan", plan(), "--plan-scale", "1.15:1.35"));
  const { page } = tab;
  assert.match((await page.textContent("#summary"))!, /^1 of 1 hang on the plan /);
  assert.ok(await page.isChecked("#layer-plan"));
  assert.equal(await page.locator(".left-out").count(), 0);
  await tab.screenshot("plan_one");
  assert.ok(await tab.changes(() => page.click("#layer-plan")));
  await tab.close();
});

test("a served page shows the plan too", async () => {
  const { server, address } = await view(planned());
  try {
    const tab = await open(address);
    assert.ok(await tab.changes(() => tab.page.click("#layer-plan")));
    await tab.close();
  } finally {
    server.kill();
  }
});

test("a plan that no map hangs on waits to be asked for, and says that it is a guess", async () => {
  const folder = mergeInto("strangers_plan", examples, "--plan", elsewhere, "--plan-scale", "0.9:1.1");
  assert.deepEqual(reportData(folder).plan!.maps, []);
  const tab = await open(folder);
  const { page } = tab;
  assert.ok(!(await page.isChecked("#layer-plan")));
  assert.match((await page.textContent(".layer:has(#layer-plan)"))!, /nothing that is shown here hangs on it/);
  assert.ok(await tab.changes(() => page.click("#layer-plan")));
  await tab.screenshot("plan_guess");
  await tab.close();
});

test("a merge without a plan has no such layer", async () => {
  const tab = await open(mergeInto("three", examples));
  assert.equal(await tab.page.locator("#layer-plan").count(), 0);
  await tab.page.focus("canvas");
  assert.ok(!(await tab.changes(() => tab.page.keyboard.press("p"))));
  await tab.close();
});
