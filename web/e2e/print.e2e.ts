/** From a model to its film image, as somebody does it who is here for the first time. */
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Browser } from 'playwright-core';
import { afterAll, beforeAll, expect, test } from 'vitest';
import { isAccessible, launch, open, picture, visit } from './browser';
import { bin, Daemon } from './daemon';
import { makeBall } from './models';

let daemon: Daemon;
let browser: Browser;
beforeAll(async () => {
  [daemon, browser] = await Promise.all([Daemon.start(), launch()]);
});
afterAll(async () => {
  await browser?.close();
  await daemon?.stop();
});

const files = () => makeBall(mkdtempSync(join(daemon.folder, 'model-')));

test('the first screen is small, there within a second, and says what to do', async () => {
  const person = await visit(browser, 'about:blank');
  const sizes: number[] = [];
  person.page.on('requestfinished', (request) => {
    request.sizes().then(
      ({ responseBodySize }) => sizes.push(responseBodySize),
      () => {}, // of the stream, which ends with the page
    );
  });
  const begun = Date.now();
  await person.page.goto(daemon.address);
  await person.page.getByRole('button', { name: 'Choose files' }).waitFor();
  const took_ms = Date.now() - begun;
  await person.page.waitForLoadState('load');
  const total = sizes.reduce((sum, size) => sum + size, 0);
  expect(total).toBeLessThan(300_000);
  expect(total).toBeGreaterThan(1000);
  console.log(`first screen: ${Math.round(total / 1000)} kB, ${took_ms} ms`);
  await picture(person, 'new-print-empty');
  await isAccessible(person, 'new print, empty');
  expect(person.complaints).toEqual([]);
  await person.context.close();
});

test('a model is dropped, turned, submitted, watched; its film image is the worker’s own', async () => {
  const person = await visit(browser, daemon.address);
  const { page } = person;
  const { obj, mtl, png } = files();
  await page.locator('input[type=file]').setInputFiles([obj, mtl, png]);
  await page.locator('.stage canvas').waitFor();

  await page.getByLabel('Longest side').fill('30');
  await page.getByRole('button', { name: '+90° x' }).click();
  await page.getByLabel('Turn about z').fill('30');
  await page.getByLabel('To the right').fill('12,5');
  await page.getByLabel('Resolution').selectOption('150 dpi');
  await page.waitForTimeout(600);
  await picture(person, 'new-print');
  await isAccessible(person, 'new print');

  // A reload loses nothing.
  await page.reload();
  await page.locator('.stage canvas').waitFor();
  expect(await page.getByLabel('Longest side').inputValue()).toBe('30');
  expect(await page.getByLabel('Turn about z').inputValue()).toBe('30');
  expect(await page.getByLabel('To the right').inputValue()).toBe('12.5');

  await page.getByRole('button', { name: 'Compute the film image' }).click();
  await page.waitForURL(/#\/jobs\/\d+$/);
  const name = page.url().split('#/')[1]!;
  await page.locator('.film-viewer canvas').waitFor({ timeout: 240_000 });
  await page.waitForTimeout(500);
  await picture(person, 'job-film');
  await isAccessible(person, 'job, film image');

  await page.getByRole('button', { name: /Compare with/ }).click();
  await page.getByLabel(/Where the film image ends/).waitFor();
  await picture(person, 'job-compare');
  await page.getByRole('radio', { name: 'Object' }).check();
  await page.locator('.stage canvas').waitFor();
  await page.getByRole('radio', { name: 'Stretch' }).check();
  await page.locator('.warnings button').first().click();
  await page.waitForTimeout(800);
  await picture(person, 'job-stretch');
  await isAccessible(person, 'job, stretch');
  await page.getByRole('radio', { name: 'Contact time' }).check();
  await page.getByLabel('Time of the dip').fill('3');
  await page.waitForTimeout(500);
  await picture(person, 'job-contact');

  await page.getByRole('radio', { name: 'Files' }).check();
  const download = page.waitForEvent('download');
  await page.getByRole('link', { name: 'film.png' }).click();
  const got = join(daemon.folder, 'got.png');
  await (await download).saveAs(got);
  await picture(person, 'job-files');

  const spec = (await page.evaluate(
    async (address) => (await fetch(address)).json(),
    `/v1/${name}`,
  )) as { simulate: { scale: number; pose: { rotationWxyz: number[]; translationMm: number[] } } };
  const own = runWorker(obj, spec.simulate);
  expect(readFileSync(got).equals(readFileSync(own))).toBe(true);
  expect(person.complaints).toEqual([]);
  await person.context.close();
});

/** The worker's own film image of the same. */
function runWorker(
  obj: string,
  { scale, pose }: { scale: number; pose: { rotationWxyz: number[]; translationMm: number[] } },
): string {
  const out = mkdtempSync(join(daemon.folder, 'own-'));
  const poseFile = join(out, 'pose.json');
  writeFileSync(
    poseFile,
    JSON.stringify({ rotation_wxyz: pose.rotationWxyz, translation_mm: pose.translationMm }),
  );
  const result = join(out, 'result');
  execFileSync(join(bin, 'hydroprint-worker'), [
    ...['simulate', '--mesh', obj, '--out', result, '--scale', String(scale)],
    ...['--pose', poseFile, '--dpi', '150'],
  ]);
  return join(result, 'film.png');
}

test('run again with changes begins with what the job was made of', async () => {
  const person = await visit(browser, `${daemon.address}/#/jobs/1`);
  const { page } = person;
  await page.getByRole('link', { name: 'Run again with changes' }).click();
  await page.locator('.stage canvas').waitFor();
  expect(await page.getByLabel('Longest side').inputValue()).toBe('30');
  expect(await page.getByLabel('Turn about z').inputValue()).toBe('30');
  await page.getByLabel('Resolution').selectOption('300 dpi');
  await page.getByRole('button', { name: 'Compute the film image' }).click();
  await page.waitForURL(/#\/jobs\/2$/);
  await page.locator('.film-viewer canvas').waitFor({ timeout: 240_000 });
  await page.getByRole('button', { name: 'Make the PDF to print' }).click();
  await page.waitForURL(/#\/jobs\/3$/);
  await page.getByRole('link', { name: 'print.pdf' }).waitFor({ timeout: 60_000 });
  await picture(person, 'job-pages');
  await page.context().close();
});

test('wrong files are refused, each with its reason and what to do', async () => {
  const person = await visit(browser, daemon.address);
  const { page } = person;
  const made = (name: string, text: string) => ({
    name,
    mimeType: 'application/octet-stream',
    buffer: Buffer.from(text),
  });
  await page
    .locator('input[type=file]')
    .setInputFiles([
      made('part.step', 'ISO-10303-21;'),
      made('picture.png', '<svg onload=alert(1)>'),
      made('<img src=x onerror=alert(1)>.obj', 'v 0 0 0\nf 1 2 3\n'),
    ]);
  const problems = page.locator('.problems');
  await problems.getByText('part.step').waitFor();
  await problems.getByText('Export it as STL, PLY or OBJ').waitFor();
  expect(await page.locator('.problems img').count()).toBe(0);
  await page.locator('input[type=file]').setInputFiles([made('short.obj', 'v 0 0 0\nf 1 2 3\n')]);
  await problems.getByText(/line 2/).waitFor();
  await picture(person, 'new-print-refused');
  await isAccessible(person, 'new print, refused');
  expect(await page.getByRole('button', { name: 'Compute the film image' }).count()).toBe(0);
  expect(person.complaints).toEqual([]);
  await page.context().close();
});

test('two people see each other’s jobs; a page heals when the daemon comes back', async () => {
  const [ann, bob] = [
    await visit(browser, daemon.address),
    await visit(browser, daemon.address, 390),
  ];
  await open(bob, '/jobs');
  await bob.page.getByRole('link', { name: 'ball' }).first().waitFor();
  const before = await bob.page.locator('.jobs tbody tr').count();
  const { obj, mtl, png } = files();
  await ann.page.locator('input[type=file]').setInputFiles([obj, mtl, png]);
  await ann.page.getByLabel('Longest side').fill('25');
  await ann.page.getByRole('button', { name: 'Compute the film image' }).click();
  await ann.page.waitForURL(/#\/jobs\/\d+$/);
  await expect
    .poll(() => bob.page.locator('.jobs tbody tr').count(), { timeout: 15_000 })
    .toBe(before + 1);

  await daemon.stopDaemon('kill');
  await ann.page.getByText('The connection to the daemon is lost').waitFor({ timeout: 30_000 });
  await picture(ann, 'connection-lost');
  await daemon.startDaemon();
  await ann.page
    .getByText('The connection to the daemon is lost')
    .waitFor({ state: 'hidden', timeout: 30_000 });
  await ann.page.locator('.film-viewer canvas').waitFor({ timeout: 240_000 });
  await picture(bob, 'jobs');
  await isAccessible(bob, 'jobs');
  await ann.context.close();
  await bob.context.close();
});
