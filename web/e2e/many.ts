// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { statSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { open } from "./browser";
import { fleet } from "./fleet";
import { elsewhere, examples, mergeInto } from "./reports";

const count = 200;

test("a page of many maps begins with an overview, and the merged map alone is drawn", async () => {
  const tab = await open(fleet(count));
  const { page } = tab;
  assert.equal(await page.getAttribute("#tab-overview", "aria-selected"), "true");
  assert.equal(await page.locator(".merged-tile").count(), 3);
  assert.match((await page.textContent(".merged-tile >> nth=0"))!, /merged\.yaml145 mapsleast sure 0\.99/);
  assert.equal(await page.getAttribute("[data-merged='true']", "aria-pressed"), "true");
  // Each tile shows something.
  const shades = await page.locator(".merged-tile canvas").evaluateAll((all) => all.map((canvas) => {
    const { width, height } = canvas as HTMLCanvasElement;
    return new Set((canvas as HTMLCanvasElement).getContext("2d")!.getImageData(0, 0, width, height).data).size;
  }));
  assert.ok(shades.every((different) => different > 2), String(shades));
  await tab.screenshot("many_overview");
  assert.ok(await tab.changes(() => page.click(".merged-tile[data-component='1']")));
  assert.equal(await page.locator("#scene").inputValue(), "1");
  await tab.close();
});

test("a map is found by its name, with its joins and ways that are open", async () => {
  const tab = await open(fleet(count));
  const { page } = tab;
  await page.fill("#panel-overview .search", "ROBOT_20");
  assert.deepEqual(await page.locator(".hit bdi").allTextContents(), ["robot_20.yaml", "robot_200.yaml"]);
  assert.ok(await tab.changes(() => page.click(".hit >> nth=0")));
  assert.match((await page.textContent(".one-map"))!, /In merged\.yaml, probability 0\.998/);
  const joins = await page.locator(".own-joins li").allTextContents();
  assert.match(joins[0], /robot_\d+\.yaml(accepted|rescued)/);
  await tab.screenshot("many_one_map");
  await page.click(".own-joins button >> nth=0");
  assert.equal(await page.getAttribute("#tab-joins", "aria-selected"), "true");
  assert.match((await page.textContent(".chosen-join"))!, /believed by itself/);
  // The other panels follow the search.
  assert.equal(await page.locator("#panel-joins .search").inputValue(), "ROBOT_20");
  await page.click("#tab-overview");
  await page.fill("#panel-overview .search", String(count - 4));
  await page.click(".hit >> nth=0");
  assert.match((await page.textContent(".one-map"))!, /Left out: /);
  assert.equal(await page.locator(".one-map .open-ways li").count(), 1);
  assert.match((await page.textContent(".one-map .open-ways"))!, /probability 0\.31/);
  await page.fill("#panel-overview .search", "nobody");
  assert.match((await page.textContent(".hits"))!, /No map is called so/);
  await tab.close();
});

test("of many maps no list is longer than can be read", async () => {
  const tab = await open(fleet(count));
  const { page } = tab;
  await page.click("#tab-layers");
  assert.equal(await page.locator(".layer[data-map]").count(), 50);
  assert.match((await page.textContent("#panel-layers"))!, /50 of 145 maps/);
  await page.fill("#panel-layers .search", "robot_13.yaml");
  assert.equal(await page.locator(".layer[data-map]").count(), 1);
  await page.click("#tab-transforms");
  await page.waitForFunction(() => document.querySelectorAll("#panel-transforms tr.pose").length === 1);
  await page.click("#tab-joins");
  assert.match((await page.textContent(".filters"))!, new RegExp(`refused \\(${400 * count + 1000}\\)`));
  await page.fill("#panel-joins .search", "");
  await page.check("#outcome-refused");
  assert.equal(await page.locator("#panel-joins tbody tr").count(), 50);
  await tab.screenshot("many_joins");
  await tab.close();
});

test("the page of a thousand maps is small enough to be mailed", () => {
  const bytes = statSync(join(fleet(1000), "report.html")).size;
  assert.ok(bytes < 20e6, `${bytes} bytes`);
});

test("ways that stay open are told", async () => {
  const strict = mergeInto("open", [examples[0], examples[1], elsewhere], "--accept", "1");
  const tab = await open(strict);
  const { page } = tab;
  const section = page.locator("#panel-layers .open-ways");
  assert.match((await section.textContent())!, /Perhapsmay lie so|Perhaps/i);
  assert.equal(await section.locator("li").count() > 0, true);
  assert.match((await section.locator("li").first().textContent())!, /robot_2\.yaml in the frame of .*robot_1\.yaml.*probability/);
  await tab.screenshot("open_ways");
  assert.ok(await tab.changes(() => section.locator("button").first().click()));
  assert.equal(await page.getAttribute("#tab-hand", "aria-selected"), "true");
  await tab.close();
});

test("a search finds maps that were left out, and a map that was found stays pointed out", async () => {
  const tab = await open(fleet(count));
  const { page } = tab;
  await page.click("#tab-layers");
  await page.fill("#panel-layers .search", `robot_${count - 4}.yaml`);
  assert.equal(await page.locator("#panel-layers .left-out li[data-map]").count(), 1);
  assert.match((await page.textContent("#panel-layers .left-out"))!, new RegExp(`robot_${count - 4}\\.yaml`));
  await page.click("#tab-overview");
  await page.fill("#panel-overview .search", "robot_20.yaml");
  await page.click(".hit >> nth=0");
  const chosen = await tab.picture();
  await page.mouse.move(5, 5);
  assert.equal(await tab.picture(), chosen);
  // By keyboard the focus goes along, and comes back.
  await page.locator(".own-joins button").first().focus();
  await page.keyboard.press("Enter");
  assert.equal(await page.evaluate(() => document.activeElement?.className), "back");
  await tab.close();
});
