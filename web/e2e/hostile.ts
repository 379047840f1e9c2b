// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { cpSync, mkdirSync, rmSync, writeFileSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { open } from "./browser";
import { mergeInto, source } from "./reports";

/** File names, so without slashes. */
const names = [
  `<script>alert("1")<`, `"'><img src=x onerror=alert(1)>&amp;`, "<img src=x onerror=alert(2)>", "<!--<script>", "two\nlines\t\u0001",
  "\u202eover and out", "${alert(3)}{{alert(4)}}", "javascript:alert(5)", "]]>--><svg onload=alert(6)>", "a".repeat(200),
];

/** The example's maps under such names. */
function hostileMaps(): string[] {
  const folder = join(source, "build/web/maps/hostile");
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  const example = (i: number) => join(source, `examples/three_robots/robot_${1 + (i % 3)}`);
  return names.map((name, i) => {
    cpSync(`${example(i)}.pgm`, join(folder, `${i}.pgm`));
    const path = join(folder, `${name}.yaml`);
    writeFileSync(path, readFileSync(`${example(i)}.yaml`, "utf8").replace(/image: .*/, `image: ${i}.pgm`));
    return path;
  });
}

test("names of maps are text and nothing else", async () => {
  const tab = await open(mergeInto("hostile", hostileMaps()));
  const { page } = tab;
  const allowed = ["SCRIPT", "STYLE"];
  const elements = () => page.evaluate(() => [...document.querySelectorAll("script, style, img, iframe, object, embed, svg *, a")]
    .map((element) => element.tagName));
  for (const id of ["layers", "joins", "transforms", "hand"]) {
    await page.click(`#tab-${id}`);
    await page.mouse.move(300, 400);
    const tags = (await elements()).filter((tag) => !allowed.includes(tag) && !["g", "line", "circle", "text", "title"].includes(tag));
    assert.deepEqual(tags, [], `elements that nobody made, in ${id}`);
    const handlers = await page.evaluate(() => [...document.querySelectorAll("*")]
      .flatMap((element) => [...element.attributes].filter((attribute) => attribute.name.startsWith("on")).map((a) => a.name)));
    assert.deepEqual(handlers, []);
    await tab.screenshot(`hostile_${id}`);
  }
  await page.click("#tab-layers");
  const shown = await page.locator(".layer[data-map] bdi, .left-out bdi").allTextContents();
  assert.deepEqual(new Set(shown), new Set(names.map((name) => `${name}.yaml`)));
  await page.click("#tab-transforms");
  for (const button of await page.locator("#panel-transforms > .buttons button").all()) await button.click();
  await page.click("#tab-joins");
  await page.locator("button[data-join]").first().click();
  await page.click("#tab-hand");
  await page.selectOption("#hand-map", { index: 3 });
  assert.equal(await page.locator("script").count(), 2, "the data and the page's own");
  await tab.close();
});
