// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { test } from "node:test";
import { bend } from "../src/deformation";
import { apply } from "../src/se2";
import { cursor, lastCopied, middle, open } from "./browser";
import { examples, mergeInto, reportData, simulated } from "./reports";

const drifted = () =>
  simulated("drifted", 3, ["--kind", "office", "--overlap", "0.7", "--drift", "1", "--clutter", "0", "--others", "0", "--seed", "101"]);

test("bent maps are shown bent, straight and between, with arrows", async () => {
  const folder = mergeInto("bent", drifted(), "--elastic");
  const tab = await open(folder);
  const { page } = tab;
  const { members } = reportData(folder).components[0];
  assert.ok(members.some(({ deformation }) => deformation), "a map is bent");
  assert.equal(await page.inputValue("#bent"), "100");
  const bent = await tab.picture();
  await tab.screenshot("bent");
  assert.ok(await tab.changes(() => page.fill("#bent", "50")));
  assert.ok(await tab.changes(() => page.fill("#bent", "0")));
  await tab.screenshot("bent_back");
  assert.ok(await tab.changes(() => page.click("#arrows")));
  await tab.screenshot("bent_arrows");
  assert.ok(await tab.changes(() => page.hover(".layer[data-map='1'] .map-label")), "a map that is pointed out has its arrows alone");
  await page.mouse.move(5, 5);
  await page.click("#arrows");
  await page.fill("#bent", "100");
  assert.equal(await tab.picture(), bent);
  await tab.close();
});

test("readings of a bent map are of its own frame", async () => {
  const folder = mergeInto("bent", drifted(), "--elastic");
  const tab = await open(folder);
  const { page } = tab;
  const at = await middle(page);
  for (const share of ["100", "30", "0"]) {
    await page.fill("#bent", share);
    await page.mouse.move(at.x - 40, at.y + 25);
    const p = await cursor(page);
    for (const { map, transform, deformation } of reportData(folder).components[0].members) {
      const reading = (await page.textContent(`.layer[data-map='${map}'] .reading`))!;
      const [, x, y] = /^(-?[\d.]+), (-?[\d.]+) m/.exec(reading)!;
      const own = { x: Number(x), y: Number(y) };
      const there = apply(transform, deformation ? bend(deformation, own, Number(share) / 100) : own);
      assert.ok(Math.hypot(there.x - p.x, there.y - p.y) < 0.03, `${reading} lies at ${there.x}, ${there.y}`);
    }
  }
  await tab.close();
});

test("a map of another scale is told so, beside its transform", async () => {
  const [first, second, third] = simulated("true_to_scale", 3, ["--kind", "office", "--overlap", "0.7", "--drift", "0", "--others", "0", "--seed", "101"]);
  const long = second.replace(".yaml", "_long.yaml");
  writeFileSync(long, readFileSync(second, "utf8").replace("resolution: 0.05", "resolution: 0.0515"));
  const folder = mergeInto("scaled", [first, long, third], "--transform", "similarity", "--fix", `${first}`);
  const { members } = reportData(folder).components[0];
  const { scale } = members.find(({ map }) => map === 1)!.deformation!;
  assert.ok(Math.abs(scale! * 1.03 - 1) < 0.005, `${scale}`);
  const tab = await open(folder);
  await tab.page.click("#tab-transforms");
  const words = await tab.page.textContent("tr.pose[data-map='1'] + tr.more");
  assert.ok(words!.includes(`scaled by ${scale!.toFixed(4)} first`), words!);
  assert.ok(!(await tab.page.textContent("tr.pose[data-map='0'] + tr.more"))!.includes("first"), "the first map keeps its scale");
  await tab.screenshot("scaled");
  await tab.close();
});

test("only merged maps of bent maps can be straightened", async () => {
  const rigid = await open(mergeInto("three", examples));
  assert.equal(await rigid.page.locator("#bent").count(), 0);
  await rigid.close();
  const tab = await open(mergeInto("bent", drifted(), "--elastic"));
  const { page } = tab;
  await page.click("#tab-joins");
  await page.locator("button[data-join]").first().click();
  await page.click("#tab-layers");
  assert.equal(await page.locator("#bent").count(), 0, "a pair is shown as its maps were read");
  await tab.close();
});

test("what is put by hand is held against maps as they are merged", async () => {
  const [first, second, third] = simulated("true_to_scale", 3, ["--kind", "office", "--overlap", "0.7", "--drift", "0", "--others", "0", "--seed", "101"]);
  const long = second.replace(".yaml", "_long.yaml");
  writeFileSync(long, readFileSync(second, "utf8").replace("resolution: 0.05", "resolution: 0.0515"));
  const tab = await open(mergeInto("scaled", [first, long, third], "--transform", "similarity", "--fix", `${first}`));
  const { page } = tab;
  await page.click("#tab-hand");
  await page.selectOption("#hand-map", "2");
  await page.waitForSelector("#hand-yardstick:has-text('by chance')");
  const band = async () => (await page.textContent("#hand-yardstick"))!.match(/have (\d+) %/)!.map(Number)[1];
  const bent = await band();
  assert.ok(bent >= 90, `maps that fit meet their walls: ${bent} %`);
  await page.click("#tab-layers");
  await page.fill("#bent", "0");
  await page.click("#tab-hand");
  await page.selectOption("#hand-map", "2");
  await page.waitForFunction((before) => {
    const text = document.querySelector("#hand-yardstick")!.textContent!;
    return text !== "" && !text.includes(`have ${before} %`);
  }, bent);
  assert.ok(await band() < bent, "straight, they fit worse");
  await tab.close();
});

test("a link keeps how far maps are bent, and the arrows", async () => {
  const folder = mergeInto("bent", drifted(), "--elastic");
  const tab = await open(folder);
  await tab.page.fill("#bent", "30");
  await tab.page.click("#arrows");
  await tab.page.click("button[aria-label^='Copy a link']");
  const link = await lastCopied(tab.page);
  assert.match(link, /bent=0\.3&arrows=1/);
  const other = await open(link);
  assert.equal(await other.page.inputValue("#bent"), "30");
  assert.ok(await other.page.isChecked("#arrows"));
  await other.close();
  await tab.close();
});
