/** Checks that apply to every screen. */
import { mkdirSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { expect } from 'vitest';
import type { Person } from './browser';
import { root } from './daemon';

const kScreens = join(root, 'build/tests/screens');
const kWidths = [390, 1280];
const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

/**
 * Saves a screenshot at the width of a phone and of a desktop. Called directly for states that pass too quickly for
 * `look`.
 */
export async function picture({ page }: Person, name: string): Promise<void> {
  mkdirSync(kScreens, { recursive: true });
  const before = page.viewportSize()!;
  for (const width of kWidths) {
    await page.setViewportSize({ width, height: width < 600 ? 844 : 860 });
    // Wait for elements that follow the size of the window.
    await page.evaluate(
      () => new Promise((done) => setTimeout(() => requestAnimationFrame(done), 80)),
    );
    await page.screenshot({ path: join(kScreens, `${name}-${width}.png`) });
    const wide = await page.evaluate(() => {
      const { scrollWidth, clientWidth } = document.documentElement;
      if (scrollWidth <= clientWidth) return [];
      return [...document.querySelectorAll('main *')]
        .filter((element) => element.getBoundingClientRect().right > clientWidth)
        .map((element) => element.outerHTML.slice(0, 120));
    });
    expect(wide, `${name} at ${width} px is wider than the window`).toEqual([]);
    expect(await page.evaluate(covered), `${name} at ${width} px: covered by the bar`).toBe('');
  }
  await page.setViewportSize(before);
}

/** Returns the last control of the screen if the bar covers it even when scrolled to the end. Runs in the page. */
function covered(): string {
  const before = window.scrollY;
  window.scrollTo(0, document.body.scrollHeight);
  const last = [...document.querySelectorAll('main :is(a, button, input, select, summary)')]
    .filter((element) => element.checkVisibility())
    .at(-1);
  const bar = document.querySelector('nav')?.getBoundingClientRect();
  const isBelow = bar !== undefined && bar.top > window.innerHeight / 2;
  const isCovered = isBelow && last !== undefined && last.getBoundingClientRect().bottom > bar.top;
  window.scrollTo(0, before);
  return isCovered ? last.outerHTML.slice(0, 120) : '';
}

/** Saves a screenshot of a page after a failure and returns its path. */
export async function saveFailure(page: Page, name: string): Promise<string> {
  const path = join(kScreens, `failed-${name.replace(/[^a-z0-9]+/gi, '-')}.png`);
  await page.screenshot({ path, timeout: 10_000 });
  return path;
}

/** Expects no serious or critical violations from axe, in light and dark colours. */
async function isAccessible({ page }: Person, name: string): Promise<void> {
  // Injected through the debugger, because the page's Content-Security-Policy allows no other scripts.
  await page.evaluate(axe);
  for (const colorScheme of ['light', 'dark'] as const) {
    await page.emulateMedia({ colorScheme });
    const found = await page.evaluate(async () => {
      const { violations } = await (
        window as unknown as { axe: { run(): Promise<{ violations: Violation[] }> } }
      ).axe.run();
      return violations
        .filter(({ impact }) => impact === 'serious' || impact === 'critical')
        .map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.html).join(' | ')}`);
    });
    expect(found, `${name}, ${colorScheme}: serious violations found by axe`).toEqual([]);
  }
}

/** Takes screenshots as picture() does, and checks accessibility in light and dark colours. */
export async function look(person: Person, name: string): Promise<void> {
  await picture(person, name);
  await isAccessible(person, name);
  await person.page.screenshot({ path: join(kScreens, `${name}-dark.png`) });
  await person.page.emulateMedia({ colorScheme: 'light' });
}

interface Violation {
  id: string;
  impact: string;
  nodes: { html: string }[];
}
