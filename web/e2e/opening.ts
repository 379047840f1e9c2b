// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { test } from "node:test";
import { load, open } from "./browser";
import { eighteen, elsewhere, examples, large, mergeInto, reportData, six, transforms } from "./reports";

const cases: [string, () => string[]][] = [
  ["two", () => examples.slice(0, 2)],
  ["six", six],
  ["eighteen", eighteen],
  ["large", large],
];

for (const [name, maps] of cases) {
  test(`a report of ${name} opens, with nothing amiss and nothing fetched`, async () => {
    const folder = mergeInto(name, maps());
    const { members } = transforms(folder).components[0];
    assert.ok(members.length >= 2);
    const tab = await open(folder);
    assert.deepEqual(await tab.page.locator(".layer[data-map] bdi").evaluateAll((names) => names.map((n) => (n as HTMLElement).title)),
      members.map(({ source }) => source));
    assert.equal(await tab.page.locator("#panel-transforms tr.pose").count(), members.length);
    assert.equal(await tab.page.locator("#panel-joins .edge").count() > 0, true);
    assert.match((await tab.page.textContent("#summary"))!, new RegExp(`^${reportData(folder).maps.length} maps: \\d+ joined into`));
    await tab.screenshot(name);
    await tab.close();
  });
}

test("a report of maps none of which was joined shows them one by one", async () => {
  const tab = await open(mergeInto("apart", [examples[0], elsewhere]));
  assert.match((await tab.page.textContent("#summary"))!, /0 joined, 2 left out/);
  assert.equal(await tab.page.locator(".left-out:not(.open-ways) li").count(), 2);
  assert.ok(await tab.changes(() => tab.page.click(".left-out:not(.open-ways) li:nth-child(2) button:text-is('Show')")));
  await tab.close();
});

for (const scheme of ["light", "dark"] as const) {
  test(`on a phone, ${scheme}, everything fits the width`, async () => {
    const folder = mergeInto("four", [...examples, elsewhere]);
    const tab = await open(folder, { viewport: { width: 360, height: 740 }, colorScheme: scheme, hasTouch: true, isMobile: true });
    for (const id of ["layers", "joins", "transforms", "hand"]) {
      await tab.page.click(`#tab-${id}`);
      const tooWide = await tab.page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
      assert.ok(tooWide <= 0, `${id} is ${tooWide} pixels too wide`);
      await tab.screenshot(`phone_${scheme}_${id}`);
    }
    await tab.close();
  });
}

test("it says so when the data are damaged", async () => {
  const folder = mergeInto("damaged", examples.slice(0, 2));
  const html = readFileSync(`${folder}/report.html`, "utf8");
  const damage = (name: string, from: RegExp, to: string) => {
    mkdirSync(`${folder}_${name}`, { recursive: true });
    const changed = html.replace(from, to);
    assert.notEqual(changed, html);
    writeFileSync(`${folder}_${name}/report.html`, changed);
    return `${folder}_${name}`;
  };
  const cells = await open(damage("cells", /"cells":"[^"]{40}/, '"cells":"'));
  assert.match((await cells.page.textContent("#problem"))!, /damaged: .*robot_1\.yaml/);
  await cells.close();
  const json = await load(damage("json", /"maps":\[/, '"maps":[['));
  assert.match((await json.page.textContent("#problem"))!, /cannot be shown/);
  await json.close();
});
