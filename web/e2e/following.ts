// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Page } from "playwright-core";
import type { Report } from "../src/report";
import { reordered } from "../test/reports";
import { type Tab, open } from "./browser";
import { elsewhere, examples, mergeInto, view } from "./reports";

/** A node as the page sees it, whose answers all show one merge. */
class Node {
  /** None: it does not answer. */
  newest: number | null = 1;
  /** How often the page was asked for. */
  loaded = 0;
  /** In which order its answers have the maps. */
  order: number[] | null = null;

  async serve(page: Page, address: string): Promise<void> {
    await page.route(address, async (route) => {
      this.loaded++;
      const response = await route.fetch();
      const body = (await response.text()).replace(/(id="report-data">)(.*?)(<\/script>)/s, (_, start: string, json: string, end: string) => {
        const report = { ...JSON.parse(json) as Report, answer: this.newest! };
        const ordered = this.order ? reordered(report, this.order) : report;
        return start + JSON.stringify(ordered).replace(/</g, "\\u003c") + end;
      });
      await route.fulfill({ response, body });
    });
    await page.route("**/news", (route) => this.newest === null ? route.abort() : route.fulfill({ json: { answer: this.newest } }));
  }
}

const says = (page: Page, text: string) => page.waitForSelector(`#following:has-text('${text}')`);

/** Opens the page of a node that merges what a folder has. */
async function follow(folder: string, use: (tab: Tab, page: Page, node: Node, next: () => Promise<void>) => Promise<void>): Promise<void> {
  const { server, address } = await view(folder);
  try {
    const tab = await open(address);
    const node = new Node();
    await node.serve(tab.page, address);
    await tab.page.goto("about:blank");
    await tab.page.goto(address);
    await tab.settled();
    await use(tab, tab.page, node, async () => {
      node.newest!++;
      await says(tab.page, `Live: answer ${node.newest}`);
      await tab.settled();
    });
    await tab.close();
  } finally {
    server.kill("SIGKILL");
  }
}

test("the page of a node follows its answers, and stays where its reader looks", async () => {
  const { server, address } = await view(mergeInto("three", examples));
  try {
    const tab = await open(address);
    const { page } = tab;
    assert.equal(await page.locator("#following").count(), 0, "view shows one merge, which nothing follows");
    const node = new Node();
    await node.serve(page, address);
    await page.reload();
    await tab.settled();
    await says(page, "Live: answer 1");
    await tab.screenshot("following");

    await page.click("#layer-2");
    await page.click("button[aria-label='Zoom in']");
    await page.click("#tab-transforms");
    const seen = await tab.picture();
    node.newest = 2;
    await says(page, "Live: answer 2");
    assert.equal(await tab.picture(), seen, "the same view");
    assert.equal(await page.getAttribute("#tab-transforms", "aria-selected"), "true");
    assert.equal(await page.isChecked("#layer-2"), false);

    // Who moves a map is not disturbed.
    await page.click("#tab-hand");
    await page.selectOption("#hand-map", "1");
    const loaded = node.loaded;
    node.newest = 3;
    await says(page, "Answer 2; a newer one is there");
    await page.fill("#hand-x", "4.5");
    assert.equal(await page.textContent(".saving pre"), "gridmerge node --init poses.tsv");
    await page.waitForTimeout(2000);
    assert.equal(node.loaded, loaded);
    await page.click("#load-newest");
    await says(page, "Live: answer 3");
    assert.equal(node.loaded, loaded + 1);
    assert.equal(await page.inputValue("#hand-map"), "1", "it is still in hand");
    await page.click("button:text-is('Let go')");

    node.newest = null;
    await says(page, "The node does not answer: this is its answer 3");
    node.newest = 4; // it came back, or another one did
    await says(page, "Live: answer 4");
    tab.problems.length = 0; // The browser itself reports the question that was not answered.
    await tab.close();
  } finally {
    server.kill("SIGKILL");
  }
});

test("poses, colours and what is hidden stay with their maps when an answer numbers them otherwise", () => follow(mergeInto("three", examples), async (tab, page, node) => {
  await page.click("#layer-2");
  await page.fill("input[type=color][data-map='1']", "#990099");
  await page.click("#tab-hand");
  await page.selectOption("#hand-map", "0");
  await page.fill("#hand-x", "4.5");
  assert.match((await page.textContent(".saving li"))!, /^1robot_1/);
  node.newest = 2;
  node.order = [1, 2, 0];
  await says(page, "Answer 1; a newer one is there");
  await page.click("#load-newest");
  await says(page, "Live: answer 2");
  await tab.settled();
  assert.deepEqual(await page.locator(".saving li").allTextContents(), ["3robot_1.yaml"]);
  assert.equal(await page.inputValue("#hand-map"), "2", "it is still in hand");
  assert.equal(await page.inputValue("#hand-x"), "4.500");
  await tab.screenshot("following_reordered");
  await page.click("#tab-layers");
  assert.deepEqual(await Promise.all([0, 1, 2].map((map) => page.isChecked(`#layer-${map}`))), [true, false, true]);
  assert.equal(await page.inputValue("input[type=color][data-map='0']"), "#990099");
}));

test("a new answer loses nothing that the reader has done", () => follow(mergeInto("four", [...examples, elsewhere]), async (_tab, page, _node, next) => {
  await page.setViewportSize({ width: 1280, height: 400 });
  // In one scene a map is placed, and another is looked at.
  await page.click("#tab-hand");
  await page.selectOption("#hand-map", "1");
  await page.fill("#hand-x", "3.3");
  await page.fill("#hand-sd", "0.05");
  await page.click("button:text-is('Let go')");
  await page.selectOption("#scene", { index: 1 });
  await page.click("#tab-transforms");
  await page.fill("#tf-parent", "site");
  await page.fill("#tf-child", "{name}/map");
  await page.click("#tab-joins");
  await page.click("#outcome-refused");
  await page.click("button[data-column='4']");
  await page.click("button[data-column='4']");
  await page.evaluate(() => document.querySelector("#panel-joins")!.scrollTo({ top: 150 }));
  const shown = () => page.evaluate(() => ({
    scene: document.querySelector<HTMLSelectElement>("#scene")!.value,
    sorted: [...document.querySelectorAll("th[aria-sort]")].map((head) => head.getAttribute("aria-sort")),
    refused: document.querySelector<HTMLInputElement>("#outcome-refused")!.checked,
    rows: document.querySelectorAll("#panel-joins tbody tr").length,
    scrolled: document.querySelector("#panel-joins")!.scrollTop,
    focus: document.activeElement!.id,
  }));
  const before = await shown();
  assert.ok(before.scrolled > 0 && before.focus === "sort-4" && before.scene === "1", JSON.stringify(before));
  await next();
  assert.deepEqual(await shown(), before);
  await page.click("#tab-transforms");
  assert.equal(await page.inputValue("#tf-parent"), "site");
  assert.equal(await page.inputValue("#tf-child"), "{name}/map");
  await page.click("#tab-hand");
  await page.selectOption("#scene", { index: 0 });
  assert.deepEqual(await page.locator(".saving li").allTextContents(), ["2robot_2.yaml"]);
  await page.selectOption("#hand-map", "1");
  assert.equal(await page.inputValue("#hand-x"), "3.300");
  assert.equal(await page.inputValue("#hand-sd"), "0.05");
}));

test("the page goes on following, whatever has the focus", () => follow(mergeInto("three", examples), async (_tab, page, node, next) => {
  const focus = () => page.evaluate(() => document.activeElement!.id);
  await page.click("#layer-0");
  await next();
  await next();
  assert.equal(await focus(), "", "a box that was clicked is left");
  await page.focus("#layer-0");
  await page.keyboard.press("Tab");
  await page.keyboard.press("Tab");
  assert.equal(await focus(), "strength-0");
  node.order = [1, 2, 0];
  await next();
  assert.equal(await focus(), "strength-2", "it is the same robot's");
  await next();
  await page.click("#tab-hand");
  await page.selectOption("#hand-map", "1");
  await page.click("button:text-is('Let go')");
  await next();
  await next();
}));

test("what is hidden comes back as strong as it was, and a page that is loaded twice at once keeps its fields", () => follow(mergeInto("three", examples), async (tab, page, _node, next) => {
  await page.fill("#strength-1", "30");
  await page.fill("#strength-2", "0");
  await page.click("#layer-1");
  await page.click("#tab-transforms");
  await page.fill("#tf-parent", "site");
  await page.click("#tab-layers");
  await page.addInitScript(() => {
    if (sessionStorage.getItem("twice") === null) return;
    sessionStorage.removeItem("twice");
    // Before the first frame.
    addEventListener("DOMContentLoaded", () => location.reload());
  });
  await page.evaluate(() => sessionStorage.setItem("twice", ""));
  await page.reload();
  await tab.settled();
  await next();
  assert.equal(await page.evaluate(() => sessionStorage.getItem("twice")), null);
  assert.equal(await page.inputValue("#tf-parent"), "site");
  assert.ok(await page.isChecked("#layer-2"), "it is shown as weakly as can be, and not hidden");
  await page.click("#layer-1");
  assert.equal(await page.inputValue("#strength-1"), "30");
}));

test("where the browser keeps nothing, the page stays once its reader has done something", () => follow(mergeInto("three", examples), async (tab, page, node, next) => {
  const place = await page.evaluate(() => {
    dispatchEvent(new Event("pagehide"));
    const [key] = Object.keys(sessionStorage);
    sessionStorage.setItem(key, JSON.stringify({ view: { merge: 1 } }));
    return key;
  });
  await page.addInitScript(() => {
    Storage.prototype.setItem = () => {
      throw new DOMException("full", "QuotaExceededError");
    };
  });
  await page.evaluate((key) => {
    // What the page that goes would keep is not what the next one finds.
    Storage.prototype.setItem = () => {};
    return key;
  }, place);
  await next();
  assert.equal(await page.evaluate((key) => sessionStorage.getItem(key), place), null, "what nobody can read is gone");
  await next();
  await page.click("#tab-hand");
  await page.selectOption("#hand-map", "1");
  await page.fill("#hand-x", "4.5");
  await page.click("button:text-is('Let go')");
  await page.focus("canvas");
  const loaded = node.loaded;
  node.newest!++;
  await says(page, `Answer ${node.newest! - 1}; a newer one is there`);
  await page.waitForTimeout(2000);
  assert.equal(node.loaded, loaded);
  await page.click("#load-newest");
  await says(page, `Live: answer ${node.newest}`);
  await tab.settled();
  await next();
}));

test("the page waits while its reader is at work, and when it is told to", () => follow(mergeInto("three", examples), async (tab, page, node, next) => {
  /** While `begin` has been done the page stays, and after `end` it goes on. */
  const staysWhile = async (begin: () => Promise<unknown>, end: () => Promise<unknown>) => {
    await begin();
    const loaded = node.loaded;
    node.newest!++;
    await says(page, `Answer ${node.newest! - 1}; a newer one is there`);
    await page.waitForTimeout(1700);
    assert.equal(node.loaded, loaded);
    await end();
    await says(page, `Live: answer ${node.newest}`);
    await tab.settled();
  };
  await staysWhile(async () => {
    await page.focus("#layer-0");
    await page.keyboard.press("Tab");
    await page.keyboard.press("Tab");
    assert.equal(await page.evaluate(() => (document.activeElement as HTMLInputElement).type), "range");
  }, () => page.focus("#tab-layers"));
  await staysWhile(() => page.evaluate(() => getSelection()!.selectAllChildren(document.querySelector("#summary")!)),
    () => page.evaluate(() => getSelection()!.removeAllRanges()));
  await staysWhile(async () => {
    await page.click("button[aria-label='Measure']");
    await page.mouse.click(300, 250);
  }, () => page.mouse.click(350, 300));
  assert.match((await page.textContent("#measured"))!, / m: x /, "what is measured is kept");
  await next();

  await page.click("#pause:text-is('Pause')");
  await says(page, "paused");
  await staysWhile(async () => {}, async () => {
    await tab.screenshot("following_paused");
    await page.click("#load-newest");
    await says(page, `Answer ${node.newest}, paused`);
    await page.click("#pause:text-is('Follow')");
  });
}));
