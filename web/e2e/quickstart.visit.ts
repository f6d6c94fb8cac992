/**
 * A first visit through the one-time link that deploy/quickstart --keep prints (HYDROPRINT_LINK). The visit views the
 * jobs of `hydroprint loop`, some of which cannot be started on the pages.
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

/** Opens the newest successful job of that kind. */
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

test('the link signs the first admin in, and works only once', async () => {
  const { page } = admin;
  await page.getByRole('button', { name: 'Sign out' }).waitFor();
  expect(page.url()).not.toContain('sign-in');
  await open(admin, '/people');
  await page.getByRole('heading', { name: 'Add a user' }).waitFor();
  const again = await visit(browser, link);
  await again.page.getByText('A sign-in link works once').waitFor();
  expect(again.complaints).toEqual([]);
});

test('a capture is shown frame by frame, with a scale', async () => {
  const { page } = admin;
  await openJob('capture');
  const frame = page.getByRole('img', { name: /^Frame 1 of \d+/ });
  await frame.waitFor();
  await page.getByText('Distance from the camera [mm]').waitFor();
  await look(admin, 'job-capture');
});

test('a calibration shows the pose and its error', async () => {
  const { page } = admin;
  await openJob('calibrate');
  await page.getByRole('heading', { name: /^Calibration \d+/ }).waitFor();
  await page.getByText('Error (95th percentile)').waitFor();
  await page.getByRole('img', { name: 'The scan aligned with the object' }).waitFor();
  await look(admin, 'job-calibrate');
  await openJob('calibrateCamera');
  await page.getByText('Residual on the board (rms)').waitFor();
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
  await page.getByLabel('Source of the pose').selectOption(found.calibration.name);
  await page.getByText(/Pose, film and scale come from the calibration/).waitFor();
  // The rig of the loop has moved and dipped since the calibration.
  await page.getByText(/This calibration is no longer valid/).waitFor();
  expect(await page.getByRole('button', { name: 'Simulate' }).isDisabled()).toBe(true);
  await page.getByRole('heading', { name: 'Preview' }).waitFor();
  await look(admin, 'new-print-measured');
  await page.getByLabel('Source of the pose').selectOption('');
  await page.getByLabel('Rotation about z').waitFor();
  expect(admin.complaints).toEqual([]);
});
