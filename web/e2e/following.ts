// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Page } from "playwright-core";
import { open } from "./browser";
import { examples, mergeInto, view } from "./reports";

/** A node as the page sees it, whose answers all show one merge. */
class Node {
  /** None: it does not answer. */
  newest: number | null = 1;
  /** How often the page was asked for. */
  loaded = 0;

  async serve(page: Page, address: string): Promise<void> {
    await page.route(address, async (route) => {
      this.loaded++;
      const response = await route.fetch();
      const body = (await response.text()).replace('"live":true', `"live":true,"answer":${this.newest}`);
      await route.fulfill({ response, body });
    });
    await page.route("**/news", (route) => this.newest === null ? route.abort() : route.fulfill({ json: { answer: this.newest } }));
  }
}

const says = (page: Page, text: string) => page.waitForSelector(`#following:has-text('${text}')`);

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
