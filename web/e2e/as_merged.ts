// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { open } from "./browser";
import { elsewhere, examples, mergeInto } from "./reports";

test("what was placed by hand is not shown as if it were merged", async () => {
  const folder = mergeInto("four", [...examples, elsewhere]);
  const asMerged = (await open(folder)).page;
  const counts = (await asMerged.textContent("#agreement-counts"))!;
  assert.match(counts, /^\d+ cells that several maps know agree/);
  assert.equal(await asMerged.locator(".by-hand:visible").count(), 0);
  await asMerged.context().close();
  const tab = await open(`${pathToFileURL(join(folder, "report.html")).href}#placed=3:6.388,-1.19,-1.7733;2:-3.25,-20.4,2.83`);
  const { page } = tab;
  assert.equal(await page.textContent("#by-hand-note"), "2 maps are shown as placed by hand");
  assert.equal(await page.locator(".layer[data-map] .by-hand:visible").count(), 2);
  assert.equal(await page.locator(".left-out .by-hand:visible").count(), 1);
  assert.equal(await page.textContent("#agreement-counts"), `As merged, not as placed by hand: ${counts}`);
  await tab.screenshot("placed_by_hand");
  await page.click("#tab-hand");
  for (const map of ["3", "2"]) {
    await page.selectOption("#hand-map", map);
    await page.click("button:text-is('Put back')");
  }
  await page.click("#tab-layers");
  assert.equal(await page.locator(".by-hand:visible").count(), 0);
  assert.ok(!await page.isVisible("#by-hand-note"));
  assert.equal(await page.textContent("#agreement-counts"), counts);
  await tab.close();
});
