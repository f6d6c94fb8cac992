/** Starts Debian's Chromium and opens browser contexts for users in it. */
import { fileURLToPath } from 'node:url';
import { chromium, type Browser, type BrowserContext, type Page } from 'playwright-core';
import { kLanHost } from './daemon';

export const launch = (): Promise<Browser> =>
  chromium.launch({
    executablePath: fileURLToPath(new URL('chromium', import.meta.url)),
    args: [
      '--no-sandbox',
      '--use-gl=angle',
      '--use-angle=swiftshader',
      '--enable-unsafe-swiftshader',
      '--disable-quic',
      // A name of the local network, whose pages lack what browsers offer only over TLS and on this machine.
      `--host-resolver-rules=MAP ${kLanHost} 127.0.0.1`,
      '--no-first-run',
      '--disable-background-networking',
      '--disable-component-update',
      '--disable-sync',
    ],
  });

/** A user with a browser context of their own. `complaints` are the errors in the page's console. */
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
    // The page shows refused requests itself, so the browser's own message about them is ignored.
    const isRefusal = /Failed to load resource|ERR_CONNECTION|ERR_INCOMPLETE/.test(message.text());
    if (message.type() === 'error' && !isRefusal) complaints.push(message.text());
  });
  await page.goto(address);
  return { page, context, complaints };
}

/** Opens a screen by its path after the "#". */
export async function open({ page }: Person, path: string): Promise<void> {
  await page.evaluate((to) => (location.hash = to), path);
}
