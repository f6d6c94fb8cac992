/** Debian's Chromium, and what every page is held against. */
import { mkdirSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { chromium, type Browser, type BrowserContext, type Page } from 'playwright-core';
import { expect } from 'vitest';
import { root } from './daemon';

const kScreens = join(root, 'build/tests/screens');
const kWidths = [390, 1280];
const axe = createRequire(import.meta.url).resolve('axe-core/axe.min.js');

export const launch = (): Promise<Browser> =>
  chromium.launch({
    executablePath: '/usr/bin/chromium',
    args: [
      '--no-sandbox',
      '--use-gl=angle',
      '--use-angle=swiftshader',
      '--enable-unsafe-swiftshader',
      '--disable-quic',
      '--no-first-run',
      '--disable-background-networking',
      '--disable-component-update',
      '--disable-sync',
    ],
  });

/** Somebody at a browser of their own. `complaints` is what the page's console had to say. */
export interface Person {
  page: Page;
  context: BrowserContext;
  complaints: string[];
}

export async function visit(browser: Browser, address: string, width = 1280): Promise<Person> {
  const context = await browser.newContext({
    viewport: { width, height: width < 600 ? 844 : 860 },
    hasTouch: width < 600,
    reducedMotion: 'reduce',
  });
  const page = await context.newPage();
  const complaints: string[] = [];
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('console', (message) => {
    // What the daemon refuses is shown on the page; the browser's own line of it tells nothing new.
    const isRefusal = /Failed to load resource|ERR_CONNECTION|ERR_INCOMPLETE/.test(message.text());
    if (message.type() === 'error' && !isRefusal) complaints.push(message.text());
  });
  await page.goto(address);
  return { page, context, complaints };
}

/** Opens a screen by its address behind the "#". */
export async function open({ page }: Person, path: string): Promise<void> {
  await page.evaluate((to) => (location.hash = to), path);
}

/** Keeps a picture of the screen at both widths. */
export async function picture({ page }: Person, name: string): Promise<void> {
  mkdirSync(kScreens, { recursive: true });
  const before = page.viewportSize()!;
  for (const width of kWidths) {
    await page.setViewportSize({ width, height: width < 600 ? 844 : 860 });
    await page.waitForTimeout(300); // for what follows the window's size
    await page.screenshot({ path: join(kScreens, `${name}-${width}.png`) });
    const wide = await page.evaluate(() => {
      const { scrollWidth, clientWidth } = document.documentElement;
      if (scrollWidth <= clientWidth) return [];
      return [...document.querySelectorAll('main *')]
        .filter((element) => element.getBoundingClientRect().right > clientWidth)
        .map((element) => element.outerHTML.slice(0, 120));
    });
    expect(wide, `${name} at ${width} px is wider than its window`).toEqual([]);
  }
  await page.setViewportSize(before);
}

/** Nothing that axe calls serious or critical. */
export async function isAccessible({ page }: Person, name: string): Promise<void> {
  // By the debugger: the page's own policy lets no script in.
  await page.evaluate(await import('node:fs').then((fs) => fs.readFileSync(axe, 'utf8')));
  const found = await page.evaluate(async () => {
    const { violations } = await (
      window as unknown as { axe: { run(): Promise<{ violations: Violation[] }> } }
    ).axe.run();
    return violations
      .filter(({ impact }) => impact === 'serious' || impact === 'critical')
      .map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.html).join(' | ')}`);
  });
  expect(found, `${name}: what axe finds serious`).toEqual([]);
}

interface Violation {
  id: string;
  impact: string;
  nodes: { html: string }[];
}
