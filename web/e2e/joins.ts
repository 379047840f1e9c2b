// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { mkdirSync, writeFileSync } from "node:fs";
import { join as inside } from "node:path";
import { test } from "node:test";
import { open } from "./browser";
import { eighteen, elsewhere, examples, mergeInto, reportData, six, source } from "./reports";

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
  assert.match((await page.textContent(".chosen-join"))!, /those of way 1/);
  await page.click("button.back");
  assert.equal(await page.locator("button[data-join='0']:focus").count(), 1, "the focus goes back to the join");
  await page.mouse.move(5, 5);
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

test("a runner-up is taken in hand as it lies", async () => {
  const folder = mergeInto("four", [...examples, elsewhere]);
  const [join] = reportData(folder).joins;
  const tab = await open(folder);
  const { page } = tab;
  await page.click("#tab-joins");
  await page.click("button[data-join='0']");
  await page.locator(".hypotheses input").nth(1).check();
  await page.click("button.adopt");
  assert.equal(await page.inputValue("#hand-map"), String(join.moving));
  const { x, y } = join.hypotheses[1].transform;
  // The first map holds the frame of the merged one.
  assert.ok(Math.abs(Number(await page.inputValue("#hand-x")) - x) < 0.002);
  assert.ok(Math.abs(Number(await page.inputValue("#hand-y")) - y) < 0.002);
  assert.ok(await page.isVisible("#hand-save"));
  await tab.close();
});

test("a map that was moved by hand in one hypothesis does not lie so in the others", async () => {
  const tab = await open(mergeInto("four", [...examples, elsewhere]));
  const { page } = tab;
  await page.click("#tab-joins");
  await page.click("button[data-join='0']");
  await page.click("#tab-hand");
  await page.selectOption("#hand-map", "1");
  await page.focus("canvas");
  assert.ok(await tab.changes(() => page.keyboard.press("Shift+ArrowRight")));
  await page.click("#tab-joins");
  await page.locator(".hypotheses input").nth(2).check();
  await page.click("#tab-transforms");
  await tab.settled();
  assert.ok(!(await page.textContent("#panel-transforms"))!.includes("by hand"));
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

test("joins are sorted by each column, either way", async () => {
  const folder = mergeInto("six", six());
  const { joins } = reportData(folder);
  const tab = await open(folder);
  const { page } = tab;
  await page.click("#tab-joins");
  const shown = async () => (await page.locator("button[data-join]").evaluateAll(
    (buttons) => buttons.map((button) => Number((button as HTMLElement).dataset.join)))).map((index) => joins[index]);
  for (const [head, keyOf] of [["Probability", "probability"], ["Index", "acceptance_index"], ["Overlap", "overlap"]] as const) {
    await page.click(`button.sort:has-text('${head}')`);
    const keys = (await shown()).map((join) => join[keyOf]);
    assert.equal(keys.length, joins.length);
    assert.deepEqual(keys, [...keys].sort((a, b) => b - a), head);
    assert.equal(await page.getAttribute(`th:has-text('${head}')`, "aria-sort"), "descending");
    await page.keyboard.press("Enter");
    const upwards = (await shown()).map((join) => join[keyOf]);
    assert.deepEqual(upwards, [...keys].sort((a, b) => a - b), "the focus stays, and Enter turns the order around");
  }
  await page.click("button.sort:has-text('Maps')");
  const maps = (await shown()).map((join) => [join.fixed, join.moving]);
  assert.deepEqual(maps, [...maps].sort(([a, b], [c, d]) => a - c || b - d));
  await tab.close();
});

test("a rescued join says which way the merge took, and what the other maps say", async () => {
  const folder = mergeInto("eighteen", eighteen());
  const index = reportData(folder).joins.findIndex((join) => join.outcome === "rescued");
  assert.ok(index >= 0);
  const tab = await open(folder);
  const { page } = tab;
  await page.click("#tab-joins");
  await page.click(`button[data-join='${index}']`);
  const text = (await page.textContent(".explanation"))!;
  assert.match(text, /By themselves they would not be joined: [a-z ]+\. The most probable: way 1 \(0\.\d+\)/);
  assert.match(text, /The merge lays them in (way \d+|a way that is none of theirs), whose own probability is 0\.\d+\./);
  assert.match(text, /(1 other map is|\d+ other maps are) joined to both\. Over (it|them) the second map lies off by \d+robot_\d+\.yaml \d+\.\d+ m and \d+\.\d°/);
  assert.ok(!/nats/.test((await page.textContent("#panel-joins"))!));
  assert.match((await page.textContent(".hypothesis"))!, /^1: probability .*, \d+\.\d\d m and \d+\.\d° off/);
  assert.ok(await page.locator(".explanation").evaluate((list) => list.getBoundingClientRect().top >= 0), "it is in sight");
  await tab.screenshot("rescued");
  await tab.close();
});

test("joins of many maps are a matrix, with a square for each two", async () => {
  const folder = mergeInto("eighteen", eighteen());
  const { joins } = reportData(folder);
  const tab = await open(folder);
  const { page } = tab;
  await page.click("#tab-joins");
  const squares = page.locator(".edge .cell");
  const used = joins.filter(({ outcome }) => outcome !== "refused").length;
  assert.equal(await squares.count(), used);
  await page.click("#outcome-refused");
  assert.equal(await squares.count(), joins.length);
  const places = await squares.evaluateAll((all) => all.map((square) => {
    const { x, y, width, height } = square.getBoundingClientRect();
    return `${Math.round(x + width / 2)} ${Math.round(y + height / 2)}`;
  }));
  assert.equal(new Set(places).size, joins.length, "none lies on another");
  assert.ok(await tab.changes(() => page.locator(".edge .reach").first().click()));
  assert.equal(await page.locator(".edge.chosen").count(), 1);
  await tab.screenshot("matrix");
  await tab.close();
});

/** A map of which nothing is known. */
function unknownMap(): string {
  const folder = inside(source, "build/web/maps/unknown");
  mkdirSync(folder, { recursive: true });
  writeFileSync(inside(folder, "map.pgm"), Buffer.concat([Buffer.from("P5\n20 20\n255\n"), Buffer.alloc(400, 205)]));
  const path = inside(folder, "map.yaml");
  writeFileSync(path, "image: map.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
  return path;
}

test("of two maps that have nothing to compare no way is shown", async () => {
  const tab = await open(mergeInto("nothing", [examples[0], unknownMap()]));
  const { page } = tab;
  await page.click("#tab-joins");
  assert.deepEqual(await page.locator("#panel-joins tbody td.number").allTextContents(), ["–", "–", "–"]);
  await page.click("button[data-join='0']");
  assert.match((await page.textContent(".chosen-join"))!, /refused: not believed: there is too little in them to compare\.So there is no way/);
  assert.equal(await page.locator("button.adopt, .figures, .hypotheses").count(), 0);
  await tab.screenshot("nothing_to_compare");
  await page.click("#tab-transforms");
  assert.equal(await page.locator("#panel-transforms tbody tr").count(), 0, "there is no transform");
  await page.click("#tab-layers");
  assert.equal(await page.locator(".layer[data-map]").count(), 0, "and no picture");
  await tab.close();
});

test("a join that the budget has no room for says what the two maps alone say", async () => {
  const tab = await open(mergeInto("budget", examples, "--max-false-joins", "0"));
  const { page } = tab;
  assert.equal(await page.textContent("h1"), "Maps, none merged");
  await page.click("#tab-joins");
  await page.click("button[data-join='0']");
  const text = (await page.textContent(".chosen-join"))!;
  assert.match(text, /refused: it would be used, but it is too doubtful for the budget of false joins/);
  assert.match(text, /By themselves they would be joined in way 1\. The most probable: way 1 \(> 0\.9/);
  assert.ok(!/not believed/.test(text), "its probability is above 0.999");
  await tab.screenshot("over_budget");
  await tab.close();
});
