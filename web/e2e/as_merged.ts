// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { constants, inflateSync } from "node:zlib";
import { open } from "./browser";
import { elsewhere, examples, mergeInto, screenshots } from "./reports";

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

/** Of the square tiles of the map on a PDF's pages: how much wider than high each is. */
function tileShapes(pdf: Buffer): number[] {
  return [...pdf.toString("latin1").matchAll(/\/FlateDecode[^]*?stream\r?\n([^]*?)endstream/g)].flatMap(([, data]) => {
    const content = inflateSync(Buffer.from(data, "latin1"), { finishFlush: constants.Z_SYNC_FLUSH }).toString("latin1");
    return [...content.matchAll(/([\d.-]+) 0 0 ([\d.-]+) [\d.-]+ [\d.-]+ cm\n(?:.*\n){0,4}?\/X\d+ Do/g)];
  }).map(([, across, up]) => Math.abs(Number(across) / Number(up)));
}

for (const landscape of [false, true]) {
  test(`a page is printed true to scale, with what it shows, ${landscape ? "landscape" : "upright"}`, async () => {
    const tab = await open(mergeInto("four", [...examples, elsewhere]), { colorScheme: landscape ? "dark" : "light" });
    const { page } = tab;
    await page.click("#tab-joins");
    const pdf = await page.pdf({ format: "A4", landscape, path: join(screenshots, `printed_${landscape ? "landscape" : "upright"}.pdf`) });
    const shapes = tileShapes(pdf);
    assert.ok(shapes.length > 3 && shapes.every((shape) => Math.abs(shape - 1) < 0.01), `${shapes}`);
    await page.emulateMedia({ media: "print" });
    for (const text of ["robot_1.yaml", "they contradict each other", "It disagrees with the others", "In the frame", "x [m]"]) {
      assert.ok(await page.locator(`aside :text("${text}"):visible`).count() > 0, text);
    }
    assert.equal(await page.locator("aside button:visible, .hypotheses:visible, .stage-buttons:visible").count(), 0);
    await page.emulateMedia({ media: "screen" });
    assert.ok(await page.isVisible("#panel-joins") && !await page.isVisible("#panel-layers"), "the screen is as before");
    await tab.close();
  });
}

test("it is told which maps are drawn coarser than they are", async () => {
  const folder = mergeInto("four", [...examples, elsewhere]);
  const html = readFileSync(join(folder, "report.html"), "utf8");
  const coarser = join(folder, "coarser.html");
  writeFileSync(coarser, html.replace('"color":"#0072b2"', '"coarser":2,$&'));
  const tab = await open(pathToFileURL(coarser).href);
  const { page } = tab;
  assert.equal(await page.title(), "Merged maps: robot_1.yaml, robot_2.yaml and 2 more – gridmerge");
  assert.match((await page.textContent(".layer[data-map='0']"))!, /Drawn in cells 2 times as wide as its own\. $/);
  assert.equal(await page.locator(":text('Drawn in cells')").count(), 1);
  await page.click("#tab-hand");
  await page.selectOption("#hand-map", "0");
  const before = Number(await page.inputValue("#hand-x"));
  await page.focus("canvas");
  await page.keyboard.press("ArrowRight");
  assert.equal((Number(await page.inputValue("#hand-x")) - before).toFixed(3), "0.025", "a cell of its own");
  await tab.close();
});
