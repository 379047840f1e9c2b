// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { type Browser, type BrowserContextOptions, type Page, chromium } from "playwright-core";
import { screenshots } from "./reports";

let browser: Browser | null = null;

export async function start(): Promise<void> {
  browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
      "--disable-component-update", "--disable-sync"],
  });
}

export async function stop(): Promise<void> {
  await browser?.close();
  browser = null;
}

/** A page, and all that went wrong on it. */
export class Tab {
  readonly page: Page;
  readonly problems: string[] = [];
  /** Addresses that the page asked for beside its own. */
  readonly requests: string[] = [];

  constructor(page: Page) {
    this.page = page;
    page.on("console", (message) => {
      if (["error", "warning"].includes(message.type())) this.problems.push(message.text());
    });
    page.on("pageerror", (error) => this.problems.push(error.message));
    page.on("dialog", (dialog) => {
      this.problems.push(`a dialog: ${dialog.message()}`);
      void dialog.dismiss();
    });
    page.on("request", (request) => {
      if (!request.isNavigationRequest() && !/^(data|blob):/.test(request.url())) this.requests.push(request.url());
    });
  }

  /** Waits until everything is drawn as it should be. */
  async settled(): Promise<void> {
    await this.page.waitForSelector("html[data-ready]", { state: "attached" });
    await this.page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    await this.page.waitForFunction(() => document.querySelector("canvas")!.dataset.complete === "true");
  }

  /** The canvas as it is drawn now, to compare. */
  async picture(): Promise<string> {
    await this.settled();
    return this.page.evaluate(() => document.querySelector("canvas")!.toDataURL());
  }

  /** Does something and tells whether the canvas shows something else then. */
  async changes(act: () => Promise<unknown>): Promise<boolean> {
    const before = await this.picture();
    await act();
    return before !== await this.picture();
  }

  async screenshot(name: string): Promise<void> {
    await this.settled();
    await this.page.screenshot({ path: join(screenshots, `${name}.png`) });
  }

  async close(): Promise<void> {
    const address = this.page.url();
    await this.page.context().close();
    assert.deepEqual(this.problems, []);
    const own = ["/refine", "/news"].map((path) => new URL(path, address).href);
    assert.deepEqual(this.requests.filter((url) => !(url.startsWith("http://127.0.0.1:") && own.includes(url))), []);
  }
}

/** Opens a folder's report, or an address, and waits until it is drawn. */
export async function open(place: string, options: BrowserContextOptions = {}): Promise<Tab> {
  const tab = await load(place, options);
  await tab.settled();
  return tab;
}

/** The same without waiting. What is copied ends up in `copied`. */
export async function load(place: string, options: BrowserContextOptions = {}): Promise<Tab> {
  const context = await browser!.newContext({ viewport: { width: 1280, height: 800 }, ...options });
  const page = await context.newPage();
  await page.addInitScript(() => {
    const copied: string[] = [];
    Object.defineProperty(window, "copied", { value: copied });
    Object.defineProperty(navigator, "clipboard", {
      value: { writeText: (text: string) => Promise.resolve(copied.push(text)) },
    });
  });
  const tab = new Tab(page);
  await page.goto(/^(http|file):/.test(place) ? place : pathToFileURL(join(place, "report.html")).href);
  return tab;
}

/** What the page has copied last. */
export function lastCopied(page: Page): Promise<string> {
  return page.evaluate(() => (window as unknown as { copied: string[] }).copied.at(-1) ?? "");
}

/** How far two pictures of one size are apart where they differ most, of 255. */
export function farthestApart(page: Page, a: string, b: string): Promise<number> {
  return page.evaluate(async (urls) => {
    const [one, other] = await Promise.all(urls.map(async (url) => {
      const image = new Image();
      image.src = url;
      await image.decode();
      const canvas = document.createElement("canvas");
      canvas.width = image.width;
      canvas.height = image.height;
      const context = canvas.getContext("2d")!;
      context.drawImage(image, 0, 0);
      return context.getImageData(0, 0, image.width, image.height).data;
    }));
    if (one.length !== other.length) return 255;
    return one.reduce((most, value, i) => Math.max(most, Math.abs(value - other[i])), 0);
  }, [a, b]);
}

/** Where the pointer is, as the page says: metres. */
export async function cursor(page: Page): Promise<{ x: number; y: number }> {
  const text = await page.textContent("#cursor");
  const [, x, y] = /^x (-?[\d.]+) m, y (-?[\d.]+) m$/.exec(text ?? "") ?? [];
  return { x: Number(x), y: Number(y) };
}

/** The middle of the canvas. */
export async function middle(page: Page): Promise<{ x: number; y: number }> {
  const box = (await page.locator(".stage canvas").boundingBox())!;
  return { x: box.x + box.width / 2, y: box.y + box.height / 2 };
}

export async function drag(page: Page, from: { x: number; y: number }, dx: number, dy: number): Promise<void> {
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  for (let i = 1; i <= 5; i++) await page.mouse.move(from.x + (dx * i) / 5, from.y + (dy * i) / 5);
  await page.mouse.up();
}
