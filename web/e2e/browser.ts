/** Debian's Chromium, and people at it. */
import { chromium, type Browser, type BrowserContext, type Page } from 'playwright-core';

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
