// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Page } from "playwright-core";
import { apply, inverse } from "../src/se2";
import { cursor, drag, middle, open } from "./browser";
import { elsewhere, examples, mergeInto } from "./reports";

const folder = () => mergeInto("four", [...examples, elsewhere]);

/** How many pixels a metre takes, by the readings of two points. */
async function scale(page: Page): Promise<number> {
  const at = await middle(page);
  await page.mouse.move(at.x - 100, at.y);
  const left = await cursor(page);
  await page.mouse.move(at.x + 100, at.y);
  return 200 / ((await cursor(page)).x - left.x);
}

test("layers are shown and hidden, by mouse and by key", async () => {
  const tab = await open(folder());
  const { page } = tab;
  const whole = await tab.picture();
  for (const [box, key] of [["#layer-0", "1"], ["#layer-1", "2"], ["#layer-2", "3"], ["#layer-merged", "m"], ["#layer-agreement", "a"]]) {
    assert.ok(await tab.changes(() => page.click(box)), `${box} changes the picture`);
    await page.focus("canvas");
    await page.keyboard.press(key);
    assert.equal(await tab.picture(), whole, `${key} undoes ${box}`);
  }
  assert.ok(await tab.changes(() => page.click("button:text-is('None')")));
  assert.ok(await page.evaluate(() => [0, 1, 2].every((i) => !(document.getElementById(`layer-${i}`) as HTMLInputElement).checked)));
  await page.click("button:text-is('All')");
  await page.mouse.move(5, 5);
  assert.equal(await tab.picture(), whole);
  await tab.close();
});

test("layers are faded and coloured", async () => {
  const tab = await open(folder());
  const { page } = tab;
  assert.ok(await tab.changes(() => page.fill(".layer[data-map='1'] input[type=range]", "20")));
  assert.ok(await tab.changes(() => page.fill("input[aria-label*='Agreement']", "0")));
  assert.ok(await tab.changes(() => page.fill("input[type=color][data-map='0']", "#990099")));
  const badge = page.locator(".layer[data-map='0'] .badge");
  assert.equal(await badge.evaluate((element) => getComputedStyle(element).backgroundColor), "rgb(153, 0, 153)");
  assert.ok(await tab.changes(() => page.hover(".layer[data-map='2']")), "a row that is pointed at shows its map");
  await tab.screenshot("faded_and_coloured");
  await tab.close();
});

test("the view moves and zooms, by mouse, buttons and keys", async () => {
  const tab = await open(folder());
  const { page } = tab;
  const home = await tab.picture();
  const at = await middle(page);
  const before = await scale(page);

  await page.mouse.move(at.x + 50, at.y + 30);
  const held = await cursor(page);
  await page.mouse.wheel(0, -200);
  // The browser hands a wheel's turn over when it likes.
  for (let i = 0; i < 50 && Math.abs(await scale(page) / before - 1) < 0.1; i++) await tab.settled();
  assert.ok(Math.abs(await scale(page) / before - Math.exp(0.5)) < 0.05, "the wheel zooms");
  await page.mouse.move(at.x + 50, at.y + 30);
  const stillHeld = await cursor(page);
  assert.ok(Math.hypot(stillHeld.x - held.x, stillHeld.y - held.y) < 0.03, "about what is under the pointer");

  await drag(page, at, 120, -60);
  await page.mouse.move(at.x + 50 + 120, at.y + 30 - 60);
  const dragged = await cursor(page);
  assert.ok(Math.hypot(dragged.x - held.x, dragged.y - held.y) < 0.03, "dragging takes the map along");

  await page.click("button[aria-label='Show all']");
  await page.mouse.move(5, 5);
  assert.equal(await tab.picture(), home);
  for (const name of ["Zoom in", "Zoom out", "Metre grid"]) {
    assert.ok(await tab.changes(() => page.click(`button[aria-label='${name}']`)), name);
  }
  await page.click("button[aria-label='Metre grid']");
  await page.focus("canvas");
  for (const key of ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "+", "-", "g"]) {
    assert.ok(await tab.changes(() => page.keyboard.press(key)), key);
  }
  await page.keyboard.press("g");
  await page.keyboard.press("0");
  await page.focus("#tab-layers");
  assert.equal(await tab.picture(), home, "0 shows all, and the crosshair goes with the focus");
  await tab.close();
});

test("the cursor is told in the merged frame and in each map's own", async () => {
  const tab = await open(folder());
  const { page } = tab;
  const at = await middle(page);
  await page.mouse.move(at.x - 40, at.y + 25);
  const p = await cursor(page);
  const transforms = await page.evaluate(() =>
    JSON.parse(document.getElementById("report-data")!.textContent!).components[0].members.map(
      (member: { transform: unknown }) => member.transform)) as { x: number; y: number; theta: number }[];
  for (const [i, transform] of transforms.entries()) {
    const reading = (await page.textContent(`.layer[data-map='${i}'] .reading`))!;
    const [, x, y, cell] = /^(-?[\d.]+), (-?[\d.]+) m · (wall|free|unknown)$/.exec(reading)!;
    const own = apply(inverse(transform), p);
    assert.ok(Math.hypot(Number(x) - own.x, Number(y) - own.y) < 0.03, `${reading}, not ${own.x}, ${own.y}`);
    assert.ok(cell.length > 0);
  }
  await page.mouse.move(5, 5);
  assert.equal(await page.textContent("#cursor"), "");
  await page.focus("canvas");
  await page.keyboard.press("ArrowLeft");
  assert.match((await page.textContent("#cursor"))!, /^x /, "the keyboard points with the middle");
  await tab.close();
});

test("scenes are picked, and the help is shown and closed", async () => {
  const tab = await open(folder());
  const { page } = tab;
  assert.ok(await tab.changes(() => page.selectOption("#scene", { label: "left out: elsewhere.yaml" })));
  assert.equal(await page.locator(".layer[data-map]").count(), 1);
  assert.ok(await tab.changes(() => page.selectOption("#scene", { index: 0 })));
  await page.focus("canvas");
  await page.keyboard.press("?");
  assert.ok(await page.isVisible("dialog.help"));
  await tab.screenshot("help");
  await page.click("dialog.help button");
  assert.ok(!await page.isVisible("dialog.help"));
  await tab.close();
});

test("two fingers zoom", async () => {
  const tab = await open(folder(), { hasTouch: true });
  const { page } = tab;
  const at = await middle(page);
  const client = await page.context().newCDPSession(page);
  const touch = (type: "touchStart" | "touchMove" | "touchEnd", apart: number) => client.send("Input.dispatchTouchEvent", {
    type, touchPoints: type === "touchEnd" ? [] : [{ x: at.x - apart, y: at.y, id: 1 }, { x: at.x + apart, y: at.y, id: 2 }],
  });
  const before = await scale(page);
  await touch("touchStart", 50);
  for (const apart of [60, 80, 100]) await touch("touchMove", apart);
  await touch("touchEnd", 100);
  assert.ok(Math.abs(await scale(page) / before - 2) < 0.1);
  await tab.close();
});

test("tabs are reached by arrow keys", async () => {
  const tab = await open(folder());
  const { page } = tab;
  await page.focus("#tab-layers");
  for (const id of ["joins", "transforms", "hand", "layers"]) {
    await page.keyboard.press("ArrowRight");
    assert.ok(await page.isVisible(`#panel-${id}`));
    assert.equal(await page.evaluate(() => document.activeElement!.id), `tab-${id}`);
  }
  await tab.close();
});
