// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { lastCopied, open } from "./browser";
import { examples, mergeInto, source, transforms } from "./reports";

test("transforms are copied to the bit", async () => {
  const folder = mergeInto("three", examples);
  const tab = await open(folder);
  const { page } = tab;
  await page.click("#tab-transforms");
  assert.match((await page.textContent("#panel-transforms .frame"))!, /^In the frame of 1robot_1\.yaml, which is also that of merged\.yaml\./);
  assert.equal(await page.locator("tr.more:has-text('holds the frame')").count(), 1);
  const expected = transforms(folder).components[0].members.map(({ source, transform }) => ({ map: source, ...transform }));
  const all = page.locator("#panel-transforms > .buttons button");
  await all.nth(1).click();
  const copied = JSON.parse(await lastCopied(page));
  assert.deepEqual(copied, { frame: examples[0], transforms: expected });
  await all.nth(0).click();
  const yaml = await lastCopied(page);
  for (const { map, x, y, theta } of expected) {
    assert.ok(yaml.includes(`  - map: ${JSON.stringify(map)}\n    x: ${x}\n    y: ${y}\n    theta: ${theta}\n`), yaml);
  }
  await all.nth(2).click();
  assert.equal((await lastCopied(page)).trimEnd().split("\n").length, 3);
  await page.locator("tr.more").nth(1).locator("button").nth(2).click();
  const { x, y, theta } = expected[1];
  assert.equal(await lastCopied(page), "ros2 run tf2_ros static_transform_publisher " +
    `--x ${x} --y ${y} --yaw ${theta} --frame-id map --child-frame-id robot_2\n`);
  await page.fill("#tf-parent", "site");
  await page.fill("#tf-child", "{name}/map");
  await page.locator("tr.more").nth(1).locator("button").nth(2).click();
  assert.ok((await lastCopied(page)).endsWith(" --frame-id site --child-frame-id robot_2/map\n"));
  await page.waitForSelector("#panel-transforms button:text-is('Copied')");
  await tab.screenshot("transforms");
  await tab.close();
});

test("it is told whose frame transforms are in", async () => {
  const folder = mergeInto("three", examples);
  const tab = await open(folder);
  const { page } = tab;
  await page.click("#tab-joins");
  await page.locator("button[data-join]").last().click();
  const [, fixed] = /show (\S+) and/.exec((await page.locator("button[data-join]").last().getAttribute("aria-label"))!)!;
  await page.click("#tab-transforms");
  await tab.settled();
  assert.match((await page.textContent("#panel-transforms .frame"))!, new RegExp(`^In the frame of \\d${fixed}\\. `));
  await tab.close();
  const given = join(source, "build/web/poses_given.tsv");
  writeFileSync(given, `map\tx\ty\ttheta\n${examples[0]}\t100\t50\t0\n`);
  const world = await open(mergeInto("world", examples, "--init", given, "--fix", examples[0]));
  await world.page.click("#tab-transforms");
  await world.settled();
  assert.match((await world.page.textContent("#panel-transforms .frame"))!, /^In the frame in which poses were given, which is also that of/);
  await world.close();
});

test("without a clipboard the page copies by selection", async () => {
  const tab = await open(mergeInto("three", examples));
  const { page } = tab;
  await page.evaluate(() => {
    navigator.clipboard.writeText = () => Promise.reject(new Error("denied"));
  });
  await page.click("#tab-transforms");
  await page.locator("#panel-transforms > .buttons button").first().click();
  await page.waitForSelector("#panel-transforms button:text-is('Copied')");
  assert.equal(await page.locator("textarea").count(), 0);
  await tab.close();
});
