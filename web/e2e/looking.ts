// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import type { Page } from "playwright-core";
import { apply, inverse } from "../src/se2";
import { cursor, drag, farthestApart, lastCopied, middle, open } from "./browser";
import { elsewhere, examples, mergeInto, reportData } from "./reports";

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
  assert.ok(await tab.changes(() => page.hover(".layer[data-map='2'] .map-label")), "a name that is pointed at shows its map");
  await page.click("#layer-2");
  await page.mouse.move(5, 5);
  const hidden = await tab.picture();
  await page.fill(".layer[data-map='2'] input[type=range]", "40");
  assert.equal(await tab.picture(), hidden, "a hidden map stays hidden while its row is used");
  await tab.screenshot("faded_and_coloured");
  await tab.close();
});

test("beside its buttons the map takes the pointer everywhere, in a low window too", async () => {
  for (const height of [800, 300]) {
    const tab = await open(folder(), { viewport: { width: 1280, height } });
    const { free, covered } = await tab.page.evaluate(() => {
      const canvas = document.querySelector(".stage canvas")!;
      const { left, top, right, bottom } = canvas.getBoundingClientRect();
      const covered: string[] = [];
      let free = 0;
      for (let y = top + 5; y < bottom; y += 10) {
        for (let x = left + 5; x < right; x += 10) {
          const there = document.elementFromPoint(x, y);
          if (there === canvas) free++;
          else if (!there?.closest("button")) covered.push(`${x}, ${y}: ${there?.className}`);
        }
      }
      return { free, covered };
    });
    assert.deepEqual(covered, []);
    assert.ok(free > 1000, `${free} places of a window ${height} pixels high`);
    await tab.close();
  }
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
  const transforms = reportData(folder()).components[0].members.map((member) => member.transform);
  for (const [i, transform] of transforms.entries()) {
    const reading = (await page.textContent(`.layer[data-map='${i}'] .reading`))!;
    const [, x, y, cell] = /^(-?[\d.]+), (-?[\d.]+) m · (wall|free|unknown)$/.exec(reading)!;
    const own = apply(inverse(transform), p);
    assert.ok(Math.hypot(Number(x) - own.x, Number(y) - own.y) < 0.03, `${reading}, not ${own.x}, ${own.y}`);
    assert.ok(cell.length > 0);
  }
  await page.selectOption("#scene", { label: "left out: elsewhere.yaml" });
  assert.notDeepEqual(await cursor(page), p, "another scene, another frame");
  await page.selectOption("#scene", { index: 0 });
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

test("the merged map is one click away from everywhere, and covers the maps", async () => {
  const tab = await open(folder());
  const { page } = tab;
  const maps = await tab.picture();
  assert.ok(await tab.changes(() => page.click("button[data-merged='true']")));
  await page.mouse.move(5, 5);
  const merged = await tab.picture();
  await tab.screenshot("merged_map");
  await page.click("#layer-0");
  await page.click("#layer-agreement");
  await page.mouse.move(5, 5);
  assert.equal(await tab.picture(), merged, "nothing of the maps is seen");
  assert.ok(await tab.changes(() => page.fill("input[aria-label*='Merged map']", "50")), "faded it lets them through");
  await page.fill("input[aria-label*='Merged map']", "100");
  await page.click("#layer-0");
  await page.click("#layer-agreement");
  await page.click("#tab-joins");
  await page.click("button[data-join='0']");
  assert.equal(await page.getAttribute("button[data-merged='true']", "aria-pressed"), "false");
  await page.click("button[data-merged='true']");
  await page.mouse.move(5, 5);
  assert.equal(await tab.picture(), merged, "from a join, too");
  await page.focus("canvas");
  await page.keyboard.press("m");
  await page.focus("#tab-joins");
  assert.equal(await tab.picture(), maps);
  assert.equal(await page.getAttribute("button[data-merged='false']", "aria-pressed"), "true");
  await tab.close();
});

test("lengths are measured, by dragging, by clicks and by keys", async () => {
  const tab = await open(folder());
  const { page } = tab;
  const at = await middle(page);
  const metre = await scale(page);
  const before = await tab.picture();
  const reading = async () => {
    const [, length, x, y] = /^([\d.]+) m: x (-?[\d.]+) m, y (-?[\d.]+) m/.exec((await page.textContent("#measured"))!) ?? [];
    return [length, x, y].map(Number);
  };
  const isNear = (a: number[], b: number[]) => a.every((value, i) => Math.abs(value - b[i]) < 0.03);
  await page.click("button[aria-label='Measure']");
  await drag(page, { x: at.x - 90, y: at.y }, 120, -160);
  assert.ok(isNear(await reading(), [200 / metre, 120 / metre, 160 / metre]), String(await reading()));
  await tab.screenshot("measured");
  await page.mouse.click(at.x, at.y);
  await page.mouse.move(at.x + 30, at.y);
  assert.ok(isNear(await reading(), [30 / metre, 30 / metre, 0]), "the end follows");
  await page.mouse.click(at.x + 50, at.y);
  await page.mouse.move(at.x, at.y + 100);
  assert.ok(isNear(await reading(), [50 / metre, 50 / metre, 0]), "and stays where it is put");
  await page.focus("canvas");
  await page.keyboard.press("Enter");
  for (let i = 0; i < 2; i++) await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Enter");
  assert.ok(isNear(await reading(), [120 / metre, 120 / metre, 0]), "two steps of 60 pixels");
  await page.keyboard.press("Escape");
  assert.equal(await page.textContent("#measured"), "");
  await page.click("button[aria-label='Show all']");
  await page.mouse.move(5, 5);
  assert.equal(await tab.picture(), before);
  await page.focus("canvas");
  await page.keyboard.press("r");
  await page.mouse.click(at.x, at.y);
  await page.selectOption("#scene", { index: 1 });
  assert.match((await page.textContent("#measured"))!, /^Click/, "another scene, another frame");
  await tab.close();
});

test("what is seen is saved as a picture", async () => {
  const tab = await open(folder());
  const { page } = tab;
  await page.click("button[aria-label='Zoom in']");
  const download = page.waitForEvent("download");
  await page.click("button[aria-label^='Save what is seen']");
  const saved = await download;
  assert.equal(saved.suggestedFilename(), "merged.png");
  const png = readFileSync(await saved.path());
  assert.deepEqual([...png.subarray(1, 4)], [..."PNG"].map((letter) => letter.charCodeAt(0)));
  const size = await page.locator("canvas").evaluate((canvas: HTMLCanvasElement) => [canvas.width, canvas.height]);
  assert.deepEqual([png.readUInt32BE(16), png.readUInt32BE(20)], size);
  await page.mouse.move(5, 5);
  const saved64 = `data:image/png;base64,${png.toString("base64")}`;
  assert.equal(await farthestApart(page, saved64, await tab.picture()), 0, "it is what the canvas shows");
  await tab.close();
});

test("a link to a view restores it", async () => {
  const tab = await open(folder());
  const { page } = tab;
  await page.fill(".layer[data-map='1'] input[type=range]", "30");
  await page.click("#layer-2");
  await page.fill("input[type=color][data-map='0']", "#990099");
  await page.click("button:text-is('Place by hand')");
  await page.focus("canvas");
  await page.keyboard.press("Shift+ArrowUp");
  await page.keyboard.press("Escape");
  await page.click("#tab-joins");
  const at = await middle(page);
  await page.click("button[aria-label='Zoom in']");
  await drag(page, at, -37, 21);
  await page.click("button[aria-label='Metre grid']");
  await page.click("button[aria-label='Measure']");
  await drag(page, at, 90, 30);
  await page.mouse.move(5, 5);
  await page.focus("#tab-joins");
  await tab.settled();
  const seen = await tab.picture();
  await page.click("button[aria-label^='Copy a link']");
  const link = await lastCopied(page);
  assert.match(link, /report\.html#at=[\d.,-]+&tab=joins&maps=1:0\.3,2:0&colors=0:990099&placed=3:[\d.,e-]+&grid=0&ruler=/);
  assert.equal(page.url(), link);
  await tab.close();

  const other = await open(link);
  await other.page.mouse.move(5, 5);
  // A letter may lie a hundredth of a pixel beside where it was.
  assert.ok(await farthestApart(other.page, await other.picture(), seen) < 32);
  assert.ok(await other.page.isVisible("#panel-joins"));
  assert.equal(await other.page.inputValue("input[type=color][data-map='0']"), "#990099");
  await other.page.click("#tab-hand");
  assert.ok(await other.page.isVisible("#hand-save"), "what was placed by hand can be saved from the link");
  await other.page.click("#tab-joins");
  // Another link to the same report, in the same tab.
  await other.page.evaluate(() => (location.hash = "#show=join-0-1&merged=1"));
  await other.settled();
  assert.match((await other.page.textContent("#scene option:checked"))!, /^join: robot_1\.yaml and robot_2\.yaml/);
  assert.equal(await other.page.isVisible("#link-problem"), false);
  await other.page.evaluate(() => (location.hash = "#show=join-0-1&merged=1&of=0123456789abcdef"));
  await other.page.waitForSelector("#link-problem:has-text('This link is to another merge')");
  await other.screenshot("foreign_link");
  assert.equal(await other.page.inputValue("#scene"), "0");
  await other.page.evaluate(() => (location.hash = "#at=999999999,0,0.0000000001"));
  await other.settled();
  await other.page.evaluate(() => (location.hash = "#show=<script>&at=1,2,nonsense"));
  await other.page.click("#tab-layers");
  assert.equal(await other.page.inputValue("#scene"), "0");
  await other.close();
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
