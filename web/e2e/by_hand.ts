// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { readFileSync, rmSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import type { Page } from "playwright-core";
import type { InputMap } from "../src/report";
import { type SE2, apply, compose, normalizeAngle } from "../src/se2";
import { type Tab, cursor, drag, farthestApart, lastCopied, middle, open } from "./browser";
import { elsewhere, examples, gridmerge, mergeInto, reportData, source, transforms, view } from "./reports";

/** Robots 1 and 3 saw little in common, so that they are refused by themselves. */
const pair = [examples[0], examples[2]];
const truth = transforms(mergeInto("three", examples)).components[0].members[2].transform;

async function pose(page: Page): Promise<SE2> {
  const value = async (id: string) => Number(await page.inputValue(`#hand-${id}`));
  return { x: await value("x"), y: await value("y"), theta: (await value("theta")) * Math.PI / 180 };
}

async function type(page: Page, { x, y, theta }: SE2): Promise<void> {
  await page.fill("#hand-x", String(x));
  await page.fill("#hand-y", String(y));
  await page.fill("#hand-theta", String((theta * 180) / Math.PI));
}

async function score(page: Page): Promise<number> {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  return Number(/Walls met (\d+) %/.exec((await page.textContent("#hand-score"))!)?.[1] ?? -1);
}

async function takeThird(tab: Tab): Promise<void> {
  await tab.page.selectOption("#scene", { index: 0 });
  await tab.page.click(".left-out li:nth-child(2) button:text-is('Place by hand')");
}

function near(a: SE2, b: SE2): boolean {
  return Math.hypot(a.x - b.x, a.y - b.y) < 0.3 && Math.abs(normalizeAngle(a.theta - b.theta)) < 0.02;
}

test("a map that was left out is placed by hand, and the saved poses join it", async () => {
  const folder = mergeInto("pair", pair, "--accept", "1");
  assert.equal(transforms(folder).components.length, 0);
  const tab = await open(folder);
  const { page } = tab;
  await takeThird(tab);
  assert.ok(near(await pose(page), truth), "it starts where the best hypothesis has it");
  assert.match((await page.textContent("#hand-place"))!, /^Place 1 of 1 .* with 1robot_1\.yaml, probability/);
  await page.waitForSelector("#hand-yardstick:has-text('by chance')");
  const chance = Number(/up to (\d+) % by chance/.exec((await page.textContent("#hand-yardstick"))!)![1]);
  const best = await score(page);
  assert.ok(best > chance + 20, `walls met: ${best} % where the map belongs, ${chance} % by chance`);
  await type(page, { ...truth, x: truth.x + 9 });
  const elsewhereMet = await score(page);
  assert.equal(await page.textContent("#hand-place"), "");
  await page.click("#hand-next");
  assert.ok(near(await pose(page), truth), "back to the only likely place");
  await type(page, { x: truth.x + 0.2, y: truth.y - 0.2, theta: truth.theta + 0.01 });
  assert.equal(await page.textContent("#hand-place"), "");
  const close = await score(page);
  assert.ok(close > elsewhereMet && close > 60, `walls met: ${elsewhereMet} % elsewhere, ${close} % where the map belongs`);
  await tab.screenshot("by_hand");
  assert.ok(await page.isDisabled("#hand-refine"), "no engine without a server");

  const download = page.waitForEvent("download");
  await page.click("#hand-save");
  const file = join(source, "build/web/poses.tsv");
  await (await download).saveAs(file);
  await page.click("button:text-is('Copy command')");
  assert.equal(await lastCopied(page), `gridmerge merge ${pair.join(" ")} --init poses.tsv -o merged_by_hand`);
  await tab.close();

  const again = join(source, "build/web/reports/pair_placed");
  const { status, output } = gridmerge("merge", ...pair, "--init", file, "-o", again);
  assert.equal(status, 0, output);
  const placed = transforms(again).components[0].members[1].transform;
  assert.ok(near(placed, truth), `${JSON.stringify(placed)}, not ${JSON.stringify(truth)}`);
  rmSync(file);
});

/** Where a map's middle is on the page when it lies at a pose. */
async function middleOfMap(page: Page, map: InputMap, at: SE2): Promise<{ x: number; y: number }> {
  const { x, y } = await middle(page);
  await page.mouse.move(x - 100, y);
  const left = await cursor(page);
  await page.mouse.move(x + 100, y);
  const right = await cursor(page);
  const scale = 200 / (right.x - left.x);
  const p = apply(compose(at, map.origin), { x: (map.width * map.resolution) / 2, y: (map.height * map.resolution) / 2 });
  return { x: x - 100 + (p.x - left.x) * scale, y: y - (p.y - left.y) * scale };
}

test("the map in hand is dragged, turned by its handle, and moved by keys", async () => {
  const folder = mergeInto("four", [...examples, elsewhere]);
  const tab = await open(folder);
  const { page } = tab;
  await page.click("button:text-is('Place by hand')");
  const start = await pose(page);
  const at = await middleOfMap(page, reportData(folder).maps[3], start);
  await drag(page, at, 60, 40);
  const dragged = await pose(page);
  assert.ok(dragged.x > start.x && dragged.y < start.y && dragged.theta === start.theta);
  await page.keyboard.down("Shift");
  await drag(page, { x: at.x + 60 + 70, y: at.y + 40 }, 0, -50);
  await page.keyboard.up("Shift");
  const turned = await pose(page);
  assert.ok(turned.theta > dragged.theta + 0.2, "up on the right turns counter-clockwise");
  await page.focus("canvas");
  await page.keyboard.press("ArrowRight");
  assert.ok(Math.abs((await pose(page)).x - turned.x - 0.05) < 0.002, "by a cell");
  await page.keyboard.press("Shift+ArrowUp");
  assert.ok(Math.abs((await pose(page)).y - turned.y - 0.5) < 0.002, "by ten");
  await page.keyboard.press("q");
  assert.ok(Math.abs((await pose(page)).theta - turned.theta - Math.PI / 360) < 1e-3);
  await page.keyboard.press("e");
  assert.ok(Math.abs((await pose(page)).theta - turned.theta) < 1e-3);
  await tab.screenshot("in_hand");
  await page.keyboard.press("Escape");
  assert.equal(await page.inputValue("#hand-map"), "");
  assert.ok(await page.isVisible("#hand-save"), "what was placed stays");
  await page.selectOption("#hand-map", "3");
  await page.click("button:text-is('Put back')");
  assert.ok(!await page.isVisible("#hand-save"));
  await tab.close();
});

test("no other numbers are saved than those that the fields show", async () => {
  const tab = await open(mergeInto("three", examples));
  const { page } = tab;
  await page.click("#tab-hand");
  await page.selectOption("#hand-map", "1");
  await page.fill("#hand-x", "4.5");
  const saved = async () => {
    const download = page.waitForEvent("download");
    await page.click("#hand-save");
    const file = join(source, "build/web/poses.tsv");
    await (await download).saveAs(file);
    const [, , row] = readFileSync(file, "utf8").split("\n");
    rmSync(file);
    return row.split("\t");
  };
  assert.deepEqual((await saved()).slice(4), ["0.3", String((2 * Math.PI) / 180)]);
  await page.press("#hand-sd-theta", "ArrowUp");
  assert.equal(await page.inputValue("#hand-sd-theta"), "2.5", "by a round step");
  const fields = [["#hand-sd", "0.05"], ["#hand-sd-theta", "1"], ["#hand-x", "2.25"], ["#hand-y", "3"], ["#hand-theta", "30"]];
  for (const [field, right] of fields) {
    for (const wrong of ["0", "-5", "", "1e9", "1e300"].filter((text) => field.startsWith("#hand-sd") || Math.abs(Number(text)) > 5 || text === "")) {
      const pose = await page.inputValue("#hand-x");
      await page.fill(field, wrong);
      assert.equal(await page.getAttribute(field, "aria-invalid"), "true", `${field} ${wrong}`);
      const isPose = !field.startsWith("#hand-sd");
      assert.equal(await page.getAttribute(field, "aria-describedby"), isPose ? "hand-pose-note" : "hand-reason");
      assert.equal(await page.getAttribute("#hand-reason", "aria-live"), isPose ? "off" : "polite", "what is wrong is heard once");
      assert.match((await page.textContent("#hand-reason"))!, /^Not to be saved: .+ has to be a number from -?[\d.]+ to \d+\.$/);
      for (const button of ["#hand-save", "button:text-is('Copy command')"]) assert.ok(await page.isDisabled(button), `${field} ${wrong}`);
      if (field === "#hand-x") {
        if (wrong === "") await tab.screenshot("wrong_number");
        await page.focus("#hand-map");
        assert.equal(await page.inputValue(field), pose, "who leaves the field sees where the map lies");
        assert.ok(await page.isEnabled("#hand-save"));
      }
    }
    await page.fill(field, right);
    assert.equal(await page.getAttribute(field, "aria-invalid"), "false");
    assert.equal(await page.getAttribute(field, "aria-describedby"), null);
    assert.equal(await page.textContent("#hand-reason"), "");
  }
  const [, x, y, theta, sd, sdTheta] = (await saved()).map(Number);
  assert.deepEqual([x, y, sd, sdTheta], [2.25, 3, 0.05, Math.PI / 180]);
  assert.ok(Math.abs(theta - Math.PI / 6) < 1e-9);
  await tab.close();
});

test("what was placed by hand outlives a page that is loaded anew, and not the tab", async () => {
  const folder = mergeInto("three", examples);
  const tab = await open(folder);
  const { page } = tab;
  await page.click("#tab-hand");
  await page.selectOption("#hand-map", "1");
  await page.fill("#hand-x", "4.5");
  await page.click("button:text-is('Let go')");
  await page.click("button[aria-label='Zoom in']");
  await page.mouse.move(5, 5);
  const seen = await tab.picture();
  await page.reload();
  assert.ok(await farthestApart(page, await tab.picture(), seen) < 32);
  assert.deepEqual(await page.locator(".saving li").allTextContents(), ["2robot_2.yaml"]);
  // In the same tab the report of another merge is another page.
  const [own, other] = [page.url(), open(mergeInto("pair", pair, "--accept", "1"))];
  await page.goto((await other).page.url());
  await (await other).close();
  await tab.settled();
  assert.ok(!await page.isVisible("#hand-save"));
  await page.goto(own);
  await tab.settled();
  assert.ok(!await page.isVisible("#hand-save"), "who opens the report begins afresh");
  await tab.close();
});

test("a map is laid at one place after the other that comparisons found", async () => {
  const tab = await open(mergeInto("four", [...examples, elsewhere]));
  const { page } = tab;
  await page.click("button:text-is('Place by hand')");
  const count = Number(/^Place 1 of (\d+)/.exec((await page.textContent("#hand-place"))!)![1]);
  assert.ok(count > 1);
  const first = await pose(page);
  const own: number[] = [];
  for (let i = 0; i < count; i++) {
    assert.match((await page.textContent("#hand-place"))!, new RegExp(`^Place ${i + 1} of ${count} `));
    own.push(Number(/probability (?:< )?([\d.]+)\.$/.exec((await page.textContent("#hand-place"))!)![1]));
    assert.ok(i === 0 || !near(await pose(page), first));
    await page.click("#hand-next");
  }
  assert.ok(near(await pose(page), first), "and round again");
  assert.deepEqual(own, [...own].sort((a, b) => b - a), "the most probable first");
  await tab.close();
});

test("a member that lies wrong is moved and put back", async () => {
  const tab = await open(mergeInto("three", examples));
  const { page } = tab;
  const whole = await tab.picture();
  await page.click("#tab-hand");
  await page.selectOption("#hand-map", "1");
  const before = await pose(page);
  await page.focus("canvas");
  await page.keyboard.press("Shift+ArrowLeft");
  assert.ok(Math.abs((await pose(page)).x - before.x + 0.5) < 0.002);
  await page.click("#tab-transforms");
  await page.waitForSelector("tr.more:has-text('placed by hand')");
  await page.click("#tab-hand");
  await page.selectOption("#hand-map", "1");
  await page.click("button:text-is('Put back')");
  assert.equal(await tab.picture(), whole);
  await tab.close();
});

test("a map that is only looked at in hand is not placed", async () => {
  const tab = await open(mergeInto("four", [...examples, elsewhere]));
  const { page } = tab;
  const whole = await tab.picture();
  await page.click("#tab-hand");
  assert.ok(await tab.changes(() => page.selectOption("#hand-map", "3")));
  assert.ok(!await page.isVisible("#hand-save"));
  await page.click("button:text-is('Let go')");
  assert.equal(await page.evaluate(() => document.activeElement!.id), "hand-map", "the focus is not lost");
  await page.click("button[aria-label='Show all']");
  await page.mouse.move(5, 5);
  assert.equal(await tab.picture(), whole);
  await page.selectOption("#hand-map", "1");
  await page.selectOption("#scene", { index: 1 });
  assert.equal(await page.inputValue("#hand-map"), "");
  assert.ok(!await page.isVisible("#hand-x"), "another scene, and the hand is empty");
  await tab.close();
});

test("a map that is only looked at in hand is not saved", async () => {
  const tab = await open(mergeInto("four", [...examples, elsewhere]));
  const { page } = tab;
  await page.click("#tab-hand");
  await page.selectOption("#hand-map", "1");
  await page.fill("#hand-x", "4.5");
  await page.selectOption("#hand-map", "3");
  const download = page.waitForEvent("download");
  await page.click("#hand-save");
  const file = join(source, "build/web/poses.tsv");
  await (await download).saveAs(file);
  const rows = readFileSync(file, "utf8").split("\n").slice(1, -1);
  rmSync(file);
  assert.deepEqual(rows.map((row) => row.split("\t")[0].replace(/^.*\//, "")), ["robot_1.yaml", "robot_2.yaml", "robot_3.yaml"]);
  await tab.close();
});

test("a page is told that another merge is served at its address now", async () => {
  const first = await view(mergeInto("pair", pair, "--accept", "1"));
  const tab = await open(first.address);
  const { page } = tab;
  await takeThird(tab);
  const before = await pose(page);
  const ended = new Promise((done) => first.server.once("exit", done));
  first.server.kill("SIGKILL");
  await ended;
  const second = await view(mergeInto("three", examples), Number(new URL(first.address).port));
  try {
    await page.click("#hand-refine");
    await page.waitForSelector(".answer:has-text('Not refined: this page is of another merge: reload it')");
    assert.deepEqual(await pose(page), before);
    tab.problems.length = 0; // The browser itself reports the answer.
    await tab.close();
  } finally {
    second.server.kill("SIGKILL");
  }
});

test("with gridmerge view the engine refines what was placed by hand", async () => {
  const { server, address } = await view(mergeInto("pair", pair, "--accept", "1"));
  try {
    const tab = await open(address);
    const { page } = tab;
    await takeThird(tab);
    await type(page, { x: truth.x + 0.4, y: truth.y - 0.3, theta: truth.theta - 0.03 });
    await page.click("#hand-refine");
    await page.waitForSelector(".answer:has-text('Moved by')");
    const refined = await pose(page);
    assert.ok(near(refined, truth), `${JSON.stringify(refined)}, not ${JSON.stringify(truth)}`);
    await tab.screenshot("refined");

    // What was said of that pose is said of no other, whatever moves the map.
    const refineAgain = async () => {
      await page.click("#hand-refine");
      await page.waitForSelector(".answer:has-text('Moved by')");
    };
    for (const leave of [
      () => type(page, { ...refined, x: refined.x + 1 }),
      () => page.press("canvas", "Shift+ArrowRight"),
      () => page.press("canvas", "q"),
      () => page.click("#hand-next"),
    ]) {
      await leave();
      assert.equal(await page.textContent(".answer"), "");
      await refineAgain();
    }
    await page.click("button:text-is('Let go')");
    await page.selectOption("#hand-map", "1");
    assert.equal(await page.textContent(".answer"), "");

    // An answer that comes late is for a pose that is no more.
    let letPass = () => {};
    const held = new Promise<void>((resolve) => (letPass = resolve));
    let asked = 0;
    await page.route("**/refine", async (route) => {
      asked++;
      await held;
      await route.continue().catch(() => {});
    });
    await type(page, { x: truth.x + 0.4, y: truth.y, theta: truth.theta });
    await page.click("#hand-refine");
    await page.click("#hand-refine");
    assert.equal(await page.textContent(".answer"), "Refining…");
    await page.fill("#hand-x", "7");
    assert.equal(await page.textContent(".answer"), "");
    letPass();
    await tab.settled();
    assert.equal(asked, 1, "one question at a time");
    assert.equal((await pose(page)).x, 7);
    await page.unroute("**/refine");

    // A server that is stopped answers when it goes on; nobody has to wait for it.
    await type(page, { x: truth.x + 0.4, y: truth.y, theta: truth.theta });
    server.kill("SIGSTOP");
    await page.click("#hand-refine");
    await page.waitForSelector(".answer:has-text('takes long to answer')");
    await tab.screenshot("refining_long");
    await page.press("#hand-x", "ArrowUp");
    assert.equal(await page.textContent(".answer"), "");
    server.kill("SIGCONT");
    await refineAgain();

    // A field in which nothing is typed shows where the map has come to.
    await type(page, { x: truth.x + 0.4, y: truth.y, theta: truth.theta });
    server.kill("SIGSTOP");
    await page.click("#hand-refine");
    await page.focus("#hand-x");
    server.kill("SIGCONT");
    await page.waitForSelector(".answer:has-text('Moved by')");
    assert.ok(near(await pose(page), refined));

    server.kill("SIGKILL");
    await type(page, { x: truth.x + 0.4, y: truth.y, theta: truth.theta });
    await page.click("#hand-refine");
    await page.waitForSelector(".answer:has-text('Not refined: gridmerge does not answer: it has ended')");
    tab.problems.length = 0; // The browser itself reports the connection that is gone.
    await tab.close();
  } finally {
    server.kill("SIGKILL");
  }
});
