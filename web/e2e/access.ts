// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Page } from "playwright-core";
import type { InputMap } from "../src/report";
import { type SE2, apply, compose } from "../src/se2";
import { cursor, drag, middle, open } from "./browser";
import { elsewhere, examples, mergeInto, reportData } from "./reports";

const folder = () => mergeInto("four", [...examples, elsewhere]);

/** Waits for what a screen reader is told. */
async function hears(page: Page, text: string): Promise<void> {
  await page.waitForFunction((expected) => document.getElementById("announcements")!.textContent === expected, text);
}

/** Where the handle of the map in hand is on the page. */
async function handleOnPage(page: Page, { origin, width, height, resolution }: InputMap): Promise<{ x: number; y: number }> {
  const at = await middle(page);
  await page.mouse.move(at.x - 50, at.y);
  const left = await cursor(page);
  await page.mouse.move(at.x + 50, at.y);
  const right = await cursor(page);
  const scale = 100 / (right.x - left.x);
  const [x, y, theta] = await Promise.all(["x", "y", "theta"].map(async (id) => Number(await page.inputValue(`#hand-${id}`))));
  const T_scene_grid: SE2 = compose({ x, y, theta: (theta * Math.PI) / 180 }, origin);
  const above = apply(T_scene_grid, { x: (width * resolution) / 2, y: height * resolution + 28 / scale });
  return { x: at.x - 50 + (above.x - left.x) * scale, y: at.y - (above.y - left.y) * scale };
}

test("the keyboard points a map out as the mouse does", async () => {
  const tab = await open(folder());
  const { page } = tab;
  const before = await tab.picture();
  await page.focus("#layer-0");
  await page.keyboard.press("Tab");
  const first = await tab.picture();
  assert.notEqual(first, before);
  for (let i = 0; i < 2; i++) await page.keyboard.press("Tab");
  assert.equal(await page.evaluate(() => document.activeElement!.id), "layer-1");
  const second = await tab.picture();
  assert.ok(second !== before && second !== first, "each map by itself");
  await tab.screenshot("pointed_out_by_keyboard");
  await page.focus("#tab-layers");
  assert.equal(await tab.picture(), before, "until the focus is elsewhere");
  await page.click("#layer-2");
  await page.click("#layer-2");
  await page.mouse.move(5, 5);
  assert.equal(await tab.picture(), before, "a click leaves nothing pointed out");
  await tab.close();
});

test("keys of the map say what they have done, and so does a button that copies", async () => {
  const tab = await open(folder());
  const { page } = tab;
  await page.focus("canvas");
  for (const [key, what] of [["1", "robot_1.yaml"], ["a", "Agreement"], ["g", "Metre grid"]]) {
    await page.keyboard.press(key);
    await hears(page, `${what} hidden`);
    await page.keyboard.press(key);
    await hears(page, `${what} shown`);
  }
  await page.keyboard.press("m");
  await hears(page, "Merged map shown");
  await page.keyboard.press("r");
  await hears(page, "Ruler shown");
  await page.keyboard.press("Escape");
  await hears(page, "Ruler hidden");
  await page.keyboard.press("ArrowLeft");
  await hears(page, (await page.textContent("#cursor"))!);
  const grid = page.getByRole("button", { name: "Metre grid" });
  assert.equal(await grid.getAttribute("aria-pressed"), "true");
  await page.keyboard.press("g");
  assert.equal(await grid.getAttribute("aria-pressed"), "false");
  await page.click("#tab-transforms");
  await page.click("button:text-is('TF') >> nth=0");
  await hears(page, "Copied robot_1.yaml as TF, for static_transform_publisher");
  // One map by itself has nothing to agree with.
  await page.selectOption("#scene", { index: 1 });
  await page.focus("canvas");
  await page.keyboard.press("g");
  await hears(page, "Metre grid shown");
  await page.keyboard.press("a");
  await hears(page, "Metre grid shown");
  await tab.close();
});

test("names of boxes and buttons are what is seen of them, without their keys", async () => {
  const tab = await open(folder());
  const { page } = tab;
  for (const name of ["robot_1.yaml", "Merged map", "Agreement"]) {
    assert.equal(await page.getByRole("checkbox", { name, exact: true }).count(), 1, name);
  }
  await page.click("#tab-hand");
  await page.selectOption("#hand-map", "3");
  await page.fill("#hand-x", "1");
  for (const id of ["layers", "joins", "transforms", "hand"]) {
    await page.click(`#tab-${id}`);
    const named = await page.locator("button[aria-label]:visible").evaluateAll((buttons) => buttons.map((button) =>
      ({ seen: button.textContent!.replace(/\s+/g, " ").trim(), label: button.getAttribute("aria-label")! })));
    for (const { seen, label } of named) assert.ok(label.includes(seen), `"${seen}" is called "${label}"`);
  }
  await tab.close();
});

test("nothing that has the focus lies under the map, however small the window is", async () => {
  for (const [width, height] of [[360, 640], [640, 400], [320, 256]]) {
    const tab = await open(folder(), { viewport: { width, height } });
    const { page } = tab;
    await page.click("#tab-joins");
    await page.locator("#panel-joins button").last().focus();
    let stops = 0;
    while (await page.evaluate(() => document.getElementById("panel-joins")!.contains(document.activeElement))) {
      const { isOnScreen, covered, what } = await page.evaluate(() => {
        const { left, right, top, bottom } = document.activeElement!.getBoundingClientRect();
        const under = [left + 6, (left + right) / 2, right - 6].map((x) => document.elementFromPoint(x, (top + bottom) / 2));
        return {
          isOnScreen: top >= 0 && bottom <= window.innerHeight + 1, covered: under.some((element) => element?.closest(".stage")),
          what: document.activeElement!.outerHTML,
        };
      });
      assert.ok(isOnScreen && !covered, `${what} at ${width} x ${height}`);
      await page.keyboard.press("Shift+Tab");
      stops++;
    }
    assert.ok(stops > 10);
    const buttons = await page.locator(".stage-buttons button").evaluateAll((all) => all.map((button) => button.getBoundingClientRect().toJSON()));
    const map = (await page.locator(".stage canvas").boundingBox())!;
    for (const { left, right, bottom } of buttons) {
      assert.ok(left >= 0 && right <= width, "all buttons are on the screen");
      assert.ok(bottom <= map.y + 1, "and beside the map");
    }
    await page.locator(".stage-buttons button").last().focus();
    await page.keyboard.press("Tab");
    assert.equal(await page.evaluate(() => document.activeElement!.id), "stage", "Tab goes down the window");
    await page.evaluate(() => window.scrollTo(0, 0));
    await tab.screenshot(`small_${width}`);
    await tab.close();
  }
});

test("the handle of a map in hand can be taken hold of, on a phone too", async () => {
  for (const viewport of [{ width: 360, height: 640 }, { width: 1280, height: 800 }]) {
    const tab = await open(folder(), { viewport });
    const { page } = tab;
    await page.click("#tab-hand");
    for (const map of [0, 1, 2, 3]) {
      await page.selectOption("#hand-map", String(map));
      await page.evaluate(() => window.scrollTo(0, 0));
      await tab.settled();
      const at = await handleOnPage(page, reportData(folder()).maps[map]);
      const there = await page.evaluate(({ x, y }) => document.elementFromPoint(x, y)?.tagName, at);
      assert.equal(there, "CANVAS", `map ${map} at ${viewport.width}`);
      const before = await page.inputValue("#hand-theta");
      await drag(page, at, 30, 10);
      assert.notEqual(await page.inputValue("#hand-theta"), before);
      await page.click("button:text-is('Put back')");
    }
    await tab.screenshot(`handle_${viewport.width}`);
    await tab.close();
  }
});

for (const scheme of ["light", "dark"] as const) {
  test(`in forced colours, ${scheme}, what colours mean is seen`, async () => {
    const tab = await open(folder(), { forcedColors: "active", colorScheme: scheme });
    const { page } = tab;
    const background = (selector: string) => page.locator(selector).evaluateAll((all) => all.map((one) => getComputedStyle(one).backgroundColor));
    assert.equal(new Set(await background(".legend .swatch")).size, 3, "both kinds and contradictions");
    assert.equal(new Set(await background(".layer .badge")).size, 3, "each map");
    const [maps, merged] = await background(".segments button");
    assert.notEqual(maps, merged, "which one is pressed");
    await tab.screenshot(`forced_${scheme}_layers`);
    await page.click("#tab-hand");
    await page.selectOption("#hand-map", "1");
    await page.waitForSelector("#hand-yardstick:has-text('by chance')");
    const [bar, fill] = [...await background(".gauge-bar"), ...await background(".gauge-fill")];
    assert.notEqual(bar, fill, "the gauge");
    await tab.screenshot(`forced_${scheme}_hand`);
    await page.click("#tab-joins");
    await page.click("button[data-join='0']");
    const [row] = await background("tr.chosen td >> nth=0");
    assert.ok(!(await background("tr:not(.chosen) td >> nth=0")).includes(row), "which join is chosen");
    await tab.screenshot(`forced_${scheme}_joins`);
    await tab.close();
  });
}

for (const scheme of ["light", "dark"] as const) {
  test(`what can be filled in has an edge that is seen, ${scheme}`, async () => {
    const tab = await open(folder(), { colorScheme: scheme });
    await tab.page.click("#tab-transforms");
    const luminances = await tab.page.locator("#scene, #tf-parent, #panel-transforms button").evaluateAll((all) => all.map((element) => {
      const luminance = (color: string) => {
        const [red, green, blue] = color.match(/\d+/g)!.map((channel) => ((Number(channel) / 255 + 0.055) / 1.055) ** 2.4);
        return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
      };
      const { borderTopColor, backgroundColor } = getComputedStyle(element);
      return [borderTopColor, backgroundColor, getComputedStyle(document.body).backgroundColor].map(luminance);
    }));
    assert.ok(luminances.length > 1);
    for (const [edge, ...beside] of luminances) {
      for (const other of beside) assert.ok((Math.max(edge, other) + 0.05) / (Math.min(edge, other) + 0.05) >= 3, `${edge} beside ${other}`);
    }
    await tab.screenshot(`edges_${scheme}`);
    await tab.close();
  });
}
