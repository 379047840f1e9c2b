// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { lastCopied, open } from "./browser";
import { examples, mergeInto, transforms } from "./reports";

test("transforms are copied to the bit", async () => {
  const folder = mergeInto("three", examples);
  const tab = await open(folder);
  const { page } = tab;
  await page.click("#tab-transforms");
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
    `--x ${x} --y ${y} --yaw ${theta} --frame-id merged --child-frame-id robot_2\n`);
  await page.waitForSelector("#panel-transforms button:text-is('Copied')");
  await tab.screenshot("transforms");
  await tab.close();
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
