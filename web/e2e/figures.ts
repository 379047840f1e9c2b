// SPDX-License-Identifier: Apache-2.0
// Measures how soon reports are seen and how smoothly the large one moves; prints a table and writes it as JSON.
import { statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { type Tab, load, middle, start, stop } from "./browser";
import { eighteen, examples, large, mergeInto, six, source } from "./reports";

interface Figures {
  report: string;
  bytes: number;
  /** Milliseconds from navigation. */
  firstPaint: number;
  drawn: number;
  /** Frames a second while the view is dragged, all of it in sight and then eleven times as near, and the longest frame in milliseconds. */
  framesPerSecond: number;
  longestFrame: number;
}

async function firstPaint(tab: Tab): Promise<number> {
  return tab.page.evaluate(() => performance.getEntriesByName("first-contentful-paint")[0].startTime);
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
  const frames = await framesWhileDragging(tab);
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
  ];
  await stop();
  console.table(all);
  writeFileSync(join(source, "build/web/figures.json"), JSON.stringify(all, null, 2) + "\n");
}

void main();
