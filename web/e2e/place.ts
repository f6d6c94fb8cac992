/** What the tests of a file share: a daemon with its virtual rig, a browser, and what happens around each test. */
import { afterAll, afterEach, beforeAll, test } from 'vitest';
import type { Browser } from 'playwright-core';
import { asAdmin } from './accounts';
import { launch } from './browser';
import { saveFailure } from './checks';
import { Daemon } from './daemon';

export interface Place {
  browser: Browser;
  daemon: Daemon;
}

/** A test that runs only in `npm run e2e:all`. Others run in every `npm run e2e`. */
export const rareTest = test.runIf(process.env['HYDROPRINT_E2E'] === 'all');

/** Starts the programs for the tests of a file. `prepare` runs once before them. */
export function usePlace(prepare?: (place: Place) => Promise<void>): Place {
  const place = {} as Place;
  beforeAll(async () => {
    [place.daemon, place.browser] = await Promise.all([Daemon.start(), launch()]);
    await prepare?.(place);
  });
  afterEach(async ({ task }) => {
    if (task.result?.state === 'fail') await report(place, task.name);
    await Promise.all(place.browser.contexts().map((context) => context.close()));
  });
  afterAll(async () => {
    await place.browser?.close();
    await place.daemon?.stop();
  });
  return place;
}

const kLogLines = 40;

/** Prints what is needed to find the cause of a failure, before the pages are closed. */
async function report({ browser, daemon }: Place, name: string): Promise<void> {
  const pages = browser.contexts().flatMap((context) => context.pages());
  const rig = async () => (await asAdmin(daemon.address))('GET', 'rig');
  const parts = await Promise.all(
    [
      rig().then((state) => `the rig: ${JSON.stringify(state)}`),
      ...pages.map((page, i) =>
        saveFailure(page, `${name} ${i + 1}`).then((path) => `page: ${path}`),
      ),
    ].map((part) => part.catch(String)),
  );
  const log = daemon.logEnd(kLogLines);
  console.error([`"${name}" failed`, ...parts, 'the end of the log:', log].join('\n'));
}
