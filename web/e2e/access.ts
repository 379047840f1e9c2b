// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Page } from "playwright-core";
import { open } from "./browser";
import { elsewhere, examples, mergeInto } from "./reports";

const folder = () => mergeInto("four", [...examples, elsewhere]);

/** Waits for what a screen reader is told. */
async function hears(page: Page, text: string): Promise<void> {
  await page.waitForFunction((expected) => document.getElementById("announcements")!.textContent === expected, text);
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
