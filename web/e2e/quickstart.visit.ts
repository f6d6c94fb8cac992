/**
 * A first visit by the one-time link that deploy/quickstart --keep ends with (HYDROPRINT_LINK), and the jobs of its loop,
 * which are of kinds that the page does not begin itself.
 */
import type { Browser } from 'playwright-core';
import { afterAll, beforeAll, expect, test } from 'vitest';
import { launch, open, visit, type Person } from './browser';
import { look } from './checks';

const link = process.env['HYDROPRINT_LINK']!;
let browser: Browser;
let admin: Person;
beforeAll(async () => {
  browser = await launch();
  admin = await visit(browser, link);
});
afterAll(() => browser.close());

/** Opens the newest job of that kind that is done. */
async function openJob(kind: string): Promise<void> {
  const name = await admin.page.evaluate(async (wanted) => {
    const { jobs } = (await (await fetch('/v1/jobs?pageSize=1000')).json()) as {
      jobs: Record<string, unknown>[];
    };
    return jobs.find((job) => job[wanted] && job['state'] === 'SUCCEEDED')?.['name'];
  }, kind);
  await open(admin, `/${String(name)}`);
  await admin.page.locator('h1', { hasText: 'done' }).waitFor();
}

test('the link signs the first admin in, and nobody a second time', async () => {
  const { page } = admin;
  await page.getByRole('button', { name: 'Sign out' }).waitFor();
  expect(page.url()).not.toContain('sign-in');
  await open(admin, '/people');
  await page.getByRole('heading', { name: 'Add a user' }).waitFor();
  const again = await visit(browser, link);
  await again.page.getByText('A link works once').waitFor();
  expect(again.complaints).toEqual([]);
});

test('what the camera saw is shown frame by frame, with a scale', async () => {
  const { page } = admin;
  await openJob('capture');
  const frame = page.getByRole('img', { name: /^Frame 1 of \d+/ });
  await frame.waitFor();
  await page.getByText('Distance from the camera [mm]').waitFor();
  await look(admin, 'job-capture');
});

test('a calibration says where the object hangs and how well that is known', async () => {
  const { page } = admin;
  await openJob('calibrate');
  await page.getByRole('heading', { name: /^Calibration \d+/ }).waitFor();
  await page.getByText(/Error, 95 % below/).waitFor();
  await page.getByRole('img', { name: 'The scan over the object' }).waitFor();
  await look(admin, 'job-calibrate');
  await openJob('calibrateCamera');
  await page.getByText('Board fits to').waitFor();
  await look(admin, 'job-calibrate-camera');
});

test('a new print takes its pose from the calibration', async () => {
  const { page } = admin;
  const found = await page.evaluate(async () => {
    const { jobs } = (await (await fetch('/v1/jobs?pageSize=1000')).json()) as {
      jobs: { name: string; simulate?: unknown; state: string }[];
    };
    const { calibrations } = (await (await fetch('/v1/calibrations')).json()) as {
      calibrations: { name: string; kind: string; pose: { translationMm: number[] } }[];
    };
    return {
      job: jobs.find((job) => job.simulate && job.state === 'SUCCEEDED')!.name,
      calibration: calibrations.find(({ kind }) => kind === 'OBJECT')!,
    };
  });
  await open(admin, `/?from=${found.job}`);
  await page.locator('.stage canvas').waitFor();
  await page.getByLabel('Pose').selectOption(found.calibration.name);
  await page.getByText(/The calibration gives pose, film and scale/).waitFor();
  // The rig of the loop has dipped and moved since.
  await page.getByText(/It does not hold any more/).waitFor();
  expect(await page.getByRole('button', { name: 'Compute the film image' }).isDisabled()).toBe(
    true,
  );
  await page.getByRole('heading', { name: 'As it hangs now' }).waitFor();
  await look(admin, 'new-print-measured');
  await page.getByLabel('Pose').selectOption('');
  await page.getByLabel('Turn about z').waitFor();
  expect(admin.complaints).toEqual([]);
});
