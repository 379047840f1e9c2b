// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { cpSync, mkdirSync, rmSync, writeFileSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { lastCopied, open } from "./browser";
import { mergeInto, reportData, source } from "./reports";

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
  const folder = mergeInto("hostile", hostileMaps());
  const tab = await open(folder);
  const { page } = tab;
  const allowed = ["SCRIPT", "STYLE"];
  const elements = () => page.evaluate(() => [...document.querySelectorAll("script, style, img, iframe, object, embed, svg *, a")]
    .map((element) => element.tagName));
  for (const id of ["layers", "joins", "transforms", "hand"]) {
    await page.click(`#tab-${id}`);
    await page.mouse.move(300, 400);
    const tags = (await elements()).filter((tag) => !allowed.includes(tag) && !["g", "line", "circle", "path", "rect", "text", "title"].includes(tag));
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
  await page.locator("#panel-transforms > .buttons button").nth(1).click();
  const copied = JSON.parse(await lastCopied(page)) as { transforms: { map: string }[] };
  const merged = reportData(folder).components[0].members.map(({ map }) => reportData(folder).maps[map].name);
  assert.deepEqual(copied.transforms.map(({ map }) => map), merged, "JSON holds the names as they are");
  await page.locator("#panel-transforms > .buttons button").nth(2).click();
  assert.match(await lastCopied(page), /^(ros2 run tf2_ros static_transform_publisher [A-Za-z0-9_. -]+ &\n)+$/);
  await page.click("#tab-joins");
  await page.locator("button[data-join]").first().click();
  await page.click("#tab-hand");
  await page.selectOption("#hand-map", { index: 3 });
  await page.focus("canvas");
  await page.keyboard.press("ArrowRight");
  assert.match((await page.textContent(".saving"))!, /rename the files first/, "no command with names that deceive");
  for (const text of await page.locator("option, title, [aria-label]").evaluateAll(
    (elements) => elements.map((element) => element.getAttribute("aria-label") ?? element.textContent!))) {
    assert.ok(!/[\u202a-\u202e]/.test(text), "marks of direction only where they are kept to themselves");
  }
  assert.equal(await page.locator("script").count(), 2, "the data and the page's own");
  await tab.close();
});
