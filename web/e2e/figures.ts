// SPDX-License-Identifier: Apache-2.0
// Measures how soon reports are seen and how smoothly the large one moves; prints a table and writes it as JSON.
import { statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { type Tab, load, middle, start, stop } from "./browser";
import { fleet } from "./fleet";
import { eighteen, examples, large, mergeInto, six, source } from "./reports";

interface Figures {
  report: string;
  bytes: number;
  /** Milliseconds from navigation. */
  firstPaint: number;
  drawn: number;
  /** Frames per second while the view is dragged, all of it in sight and then eleven times as near, and the longest frame in milliseconds. */
  framesPerSecond: number;
  longestFrame: number;
  /** Milliseconds: of the script at a stretch while it loads, and until all is drawn anew after a zoom and after a layer was hidden. */
  longestTask: number;
  redrawn: number;
  hidden: number;
  /** Megabytes of the script's heap once all is there; of many maps, milliseconds from a search to the map that it found, drawn. */
  heap: number;
  found: number;
}

async function firstPaint(tab: Tab): Promise<number> {
  return tab.page.evaluate(() => performance.getEntriesByName("first-contentful-paint")[0].startTime);
}

/** The longest stretch for which the page answered nothing so far. */
async function longestTask(tab: Tab): Promise<number> {
  return tab.page.evaluate(() => new Promise<number>((done) => {
    new PerformanceObserver((list) => done(Math.max(...list.getEntries().map((entry) => entry.duration))))
      .observe({ type: "longtask", buffered: true });
    setTimeout(() => done(0), 200); // Tasks of less than 50 ms are not reported.
  }));
}

/** Milliseconds from a click until everything is drawn. */
async function untilDrawn(tab: Tab, selector: string): Promise<number> {
  return tab.page.evaluate(async (clicked) => {
    const canvas = document.querySelector("canvas")!;
    const start = performance.now();
    document.querySelector<HTMLElement>(clicked)!.click();
    do await new Promise(requestAnimationFrame);
    while (canvas.dataset.complete !== "true");
    return performance.now() - start;
  }, selector);
}

/** Milliseconds from typing a name to the map drawn; 0 where there is no search. */
async function untilFound(tab: Tab, name: string): Promise<number> {
  return tab.page.evaluate(async (typed) => {
    const field = document.querySelector<HTMLInputElement>("#panel-overview .search");
    if (!field) return 0;
    const canvas = document.querySelector("canvas")!;
    const start = performance.now();
    field.value = typed;
    field.dispatchEvent(new Event("input"));
    document.querySelector<HTMLElement>(".hit")!.click();
    do await new Promise(requestAnimationFrame);
    while (canvas.dataset.complete !== "true");
    return performance.now() - start;
  }, name);
}

async function heap(tab: Tab): Promise<number> {
  const session = await tab.page.context().newCDPSession(tab.page);
  await session.send("HeapProfiler.collectGarbage");
  const { usedSize, backingStorageSize } = await session.send("Runtime.getHeapUsage") as { usedSize: number; backingStorageSize?: number };
  return (usedSize + (backingStorageSize ?? 0)) / 1e6;
}

/** Milliseconds between frames while the pointer drags the view to and fro for two seconds. */
async function framesWhileDragging(tab: Tab): Promise<number[]> {
  const { page } = tab;
  const at = await middle(page);
  await page.evaluate(() => {
    const times: number[] = [];
    const note = (time: number) => {
      times.push(time);
      if (frameTimes.frameTimes === times) requestAnimationFrame(note);
    };
    const frameTimes = window as unknown as { frameTimes: number[] };
    frameTimes.frameTimes = times;
    requestAnimationFrame(note);
  });
  await page.mouse.move(at.x, at.y);
  await page.mouse.down();
  const until = Date.now() + 2000;
  for (let i = 0; Date.now() < until; i++) {
    await page.mouse.move(at.x + 300 * Math.sin(i / 12), at.y + 200 * Math.sin(i / 17));
  }
  await page.mouse.up();
  const times = await page.evaluate(() => (window as unknown as { frameTimes: number[] }).frameTimes);
  return times.slice(1).map((time, i) => time - times[i]);
}

async function measure(report: string, folder: string): Promise<Figures> {
  const tab = await load(folder);
  await tab.settled();
  const drawn = await tab.page.evaluate(() => performance.now());
  const task = await longestTask(tab);
  const found = await untilFound(tab, "robot_137.yaml");
  // Of many maps, those that nobody asked for come last.
  await tab.page.waitForFunction(() => !document.querySelector("#panel-overview") || document.documentElement.dataset.all, null, { timeout: 120000 });
  const megabytes = await heap(tab);
  const redrawn = await untilDrawn(tab, "button[aria-label='Zoom in']");
  const frames = await framesWhileDragging(tab);
  const hidden = await untilDrawn(tab, "#layer-agreement");
  for (let i = 0; i < 6; i++) await tab.page.click("button[aria-label='Zoom in']");
  frames.push(...await framesWhileDragging(tab));
  const total = frames.reduce((sum, frame) => sum + frame, 0);
  const figures = {
    report,
    bytes: statSync(join(folder, "report.html")).size,
    firstPaint: Math.round(await firstPaint(tab)),
    drawn: Math.round(drawn),
    framesPerSecond: Math.round((1000 * frames.length) / total),
    longestFrame: Math.round(Math.max(...frames)),
    longestTask: Math.round(task),
    redrawn: Math.round(redrawn),
    hidden: Math.round(hidden),
    heap: Math.round(megabytes),
    found: Math.round(found),
  };
  await tab.close();
  return figures;
}

async function main(): Promise<void> {
  await start();
  const all = [
    await measure("2 maps", mergeInto("two", examples.slice(0, 2))),
    await measure("6 maps", mergeInto("six", six())),
    await measure("18 maps", mergeInto("eighteen", eighteen())),
    await measure("4000 x 4000", mergeInto("large", large())),
    await measure("1000 maps", fleet(1000)),
  ];
  await stop();
  console.table(all);
  writeFileSync(join(source, "build/web/figures.json"), JSON.stringify(all, null, 2) + "\n");
}

void main();
