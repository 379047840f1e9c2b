// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { open } from "./browser";
import { elsewhere, examples, mergeInto, six } from "./reports";

test("a join is chosen in the table and shows its two maps, its figures and its hypotheses", async () => {
  const tab = await open(mergeInto("four", [...examples, elsewhere]));
  const { page } = tab;
  await page.click("#tab-joins");
  assert.equal(await page.locator("#panel-joins tbody tr").count(), 6);
  const whole = await tab.picture();
  assert.ok(await tab.changes(() => page.click("button[data-join='0']")));
  assert.match((await page.textContent(".chosen-join h3"))!, /robot_1\.yaml and .*robot_2\.yaml/);
  assert.match((await page.textContent(".chosen-join .figures"))!, /Probability.*Acceptance index.*Overlap/s);
  await tab.screenshot("join");
  const hypotheses = page.locator(".hypotheses input");
  assert.ok(await hypotheses.count() > 2, "the runners-up are there");
  assert.ok(await tab.changes(() => hypotheses.nth(2).check()), "a runner-up lies elsewhere");
  assert.ok(await hypotheses.nth(2).isChecked());
  await tab.screenshot("runner_up");
  await page.click("button.back");
  assert.equal(await tab.picture(), whole);
  await tab.close();
});

test("a join is chosen in the graph, and kinds of joins are hidden", async () => {
  const tab = await open(mergeInto("six", six()));
  const { page } = tab;
  await page.click("#tab-joins");
  const rows = page.locator("#panel-joins tbody tr");
  const lines = page.locator(".edge");
  assert.equal(await rows.count(), await lines.count());
  const before = await rows.count();
  const refused = await page.locator("td.outcome.refused").count();
  assert.ok(refused > 0 && refused < before);
  await page.click("#outcome-refused");
  assert.equal(await rows.count(), before - refused);
  assert.equal(await lines.count(), before - refused);
  await tab.screenshot("joins_of_six");
  const [x, y] = await lines.first().locator(".reach").evaluate((line) => {
    const point = new DOMPoint(
      (Number(line.getAttribute("x1")) + 2 * Number(line.getAttribute("x2"))) / 3,
      (Number(line.getAttribute("y1")) + 2 * Number(line.getAttribute("y2"))) / 3);
    const on = point.matrixTransform((line as SVGLineElement).getScreenCTM()!);
    return [on.x, on.y];
  });
  assert.ok(await tab.changes(() => page.mouse.click(x, y)));
  assert.equal(await page.locator(".edge.chosen").count(), 1);
  assert.equal(await page.locator("tr.chosen").count(), 1);
  await tab.close();
});

test("joins are chosen by keyboard alone", async () => {
  const tab = await open(mergeInto("four", [...examples, elsewhere]));
  const { page } = tab;
  await page.focus("#tab-layers");
  await page.keyboard.press("ArrowRight");
  for (let i = 0; i < 12 && await page.locator("button[data-join]:focus").count() === 0; i++) await page.keyboard.press("Tab");
  assert.ok(await tab.changes(() => page.keyboard.press("Enter")));
  assert.equal(await page.locator("button[data-join]:focus").count(), 1, "the focus stays");
  await tab.close();
});
