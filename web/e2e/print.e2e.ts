/** From a model to its film image, as a first-time user does it. */
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { expect, test } from 'vitest';
import { addPeople, asAdmin, come, signIn } from './accounts';
import { open, visit } from './browser';
import { look } from './checks';
import { bin, kLanHost } from './daemon';
import { ballGlb, coverage, makeBall, previewOf, stripes } from './models';
import { imageIn } from './pdf';
import { rareTest, usePlace } from './place';
import { startProxy } from './proxy';
import { ball, fineRing, leaf } from './solids';

const there = usePlace(({ daemon }) => addPeople(daemon.address));

const files = () => makeBall(mkdtempSync(join(there.daemon.folder, 'model-')));

test('a maker drops a model, turns it and submits; the film image equals the worker’s own', async () => {
  const person = await come(there, 'mia');
  const { page } = person;
  const { obj, mtl, png } = files();
  await look(person, 'new-print-empty');
  await page.locator('input[type=file]').setInputFiles([obj, mtl, png]);
  await page.locator('.stage canvas').waitFor();

  // The ball's radius is 1, which is too small in mm. One click takes the likely unit.
  await page.getByText('Size: 2 × 2 × 2 mm').waitFor();
  await look(person, 'new-print-small');
  await page.getByRole('button', { name: 'Use inch' }).click();
  await page.getByText('Size: 50.8 × 50.8 × 50.8 mm').waitFor();
  expect(await page.getByRole('radio', { name: 'inch' }).isChecked()).toBe(true);
  expect(await page.getByLabel('One unit is').inputValue()).toBe('25.4');
  expect(await page.getByText('smaller than 5 mm').count()).toBe(0);
  await page.getByLabel('Longest side').fill('30');
  await page.getByRole('button', { name: '+90° x' }).click();
  await page.getByLabel('Rotation about z').fill('30');
  await page.getByLabel('Offset to the right').fill('12,5');
  await page.getByLabel('Resolution').selectOption('150 dpi');
  await look(person, 'new-print');

  // A reload keeps everything.
  await page.reload();
  await page.locator('.stage canvas').waitFor();
  expect(await page.getByLabel('Longest side').inputValue()).toBe('30');
  expect(await page.getByLabel('Rotation about z').inputValue()).toBe('30');
  expect(await page.getByLabel('Offset to the right').inputValue()).toBe('12.5');

  await page.getByRole('button', { name: 'Simulate' }).click();
  await page.waitForURL(/#\/jobs\/\d+$/);
  const name = page.url().split('#/')[1]!;
  await page.locator('.film-viewer canvas').waitFor({ timeout: 240_000 });
  await look(person, 'job-film');

  await page.getByRole('button', { name: /Compare with/ }).click();
  await page.getByLabel(/Position of the divider/).waitFor();
  await look(person, 'job-compare');
  await page.getByRole('radio', { name: 'Object' }).check();
  await page.locator('.stage canvas').waitFor();
  await page.getByRole('radio', { name: 'Stretch' }).check();
  await page.locator('.warnings button').first().click();
  await look(person, 'job-stretch');
  await page.getByRole('radio', { name: 'Error' }).check();
  await page.getByText('Stated error of the place on the film [mm]').waitFor();
  await look(person, 'job-error');
  await page.getByRole('radio', { name: 'Contact time' }).check();
  await page.getByLabel('Time since first contact').fill('3');
  await look(person, 'job-contact');

  await page.getByRole('radio', { name: 'Files' }).check();
  const download = page.waitForEvent('download');
  await page.getByRole('link', { name: 'film.png' }).click();
  const got = join(there.daemon.folder, 'got.png');
  await (await download).saveAs(got);
  await look(person, 'job-files');

  const spec = (await page.evaluate(
    async (address) => (await fetch(address)).json(),
    `/v1/${name}`,
  )) as { simulate: { scale: number; pose: { rotationWxyz: number[]; translationMm: number[] } } };
  const own = runWorker(obj, spec.simulate);
  expect(readFileSync(got).equals(readFileSync(own))).toBe(true);
  expect(person.complaints).toEqual([]);
});

/** Runs the worker directly with the same input and returns its film image. */
function runWorker(
  obj: string,
  { scale, pose }: { scale: number; pose: { rotationWxyz: number[]; translationMm: number[] } },
): string {
  const out = mkdtempSync(join(there.daemon.folder, 'own-'));
  const poseFile = join(out, 'pose.json');
  writeFileSync(
    poseFile,
    JSON.stringify({ rotation_wxyz: pose.rotationWxyz, translation_mm: pose.translationMm }),
  );
  const result = join(out, 'result');
  // With low priority, as the daemon runs it.
  execFileSync('nice', [
    ...[
      join(bin, 'hydroprint-worker'),
      'simulate',
      '--mesh',
      obj,
      '--out',
      result,
      '--scale',
      String(scale),
    ],
    ...['--pose', poseFile, '--dpi', '150'],
  ]);
  return join(result, 'film.png');
}

test('a maker prints over plain HTTP, behind a proxy that serves the page in a folder', async () => {
  const proxy = await startProxy(there.daemon.address, '/hydroprint/');
  const address = `http://${kLanHost}:${proxy.port}/hydroprint/`;
  const person = await visit(there.browser, address);
  const { page } = person;
  await signIn(page, 'mia');
  const lacks = () => [typeof crypto.subtle, typeof crypto.randomUUID];
  expect(await page.evaluate(lacks)).toEqual(['undefined', 'undefined']);

  const { obj, mtl, png } = files();
  // Comments, so that the file has several chunks.
  writeFileSync(obj, `${readFileSync(obj, 'utf8')}${`#${'x'.repeat(99)}\n`.repeat(30_000)}`);
  await page.locator('input[type=file]').setInputFiles([obj, mtl, png]);
  await page.getByRole('radio', { name: 'cm' }).check();
  await page.getByText('Size: 20.0 × 20.0 × 20.0 mm').waitFor();
  await page.getByLabel('Resolution').selectOption('150 dpi');
  await page.getByText('More settings').click();
  await page.getByLabel('Depth').fill('6');
  await page.getByLabel('Simulation model').selectOption('MODEL_STOKES');
  await page.getByRole('button', { name: 'Simulate' }).click();
  await page.waitForURL(/\/hydroprint\/#\/jobs\/\d+$/);
  // The page learns of the job's end from the event stream.
  await page.locator('.film-viewer canvas').waitFor({ timeout: 240_000 });
  expect(proxy.refused).toBe(0);

  await page.getByRole('radio', { name: 'Files' }).check();
  const download = page.waitForEvent('download');
  await page.getByRole('link', { name: 'film.png' }).click();
  expect(
    readFileSync(await (await download).path())
      .subarray(1, 4)
      .toString(),
  ).toBe('PNG');
  expect(person.complaints).toEqual([]);

  // A sign-in link, and an address below the page.
  const send = await asAdmin(there.daemon.address);
  const { token } = await send<{ token: string }>('POST', 'users/vera:createSignInLink');
  const vera = await visit(there.browser, `${address}sign-in#${token}`);
  await vera.page.getByRole('button', { name: 'Sign out' }).waitFor();
  expect(vera.page.url()).toBe(address);
  await vera.page.goto(`${address}jobs/1`);
  await vera.page.getByRole('button', { name: 'Sign out' }).waitFor();
  expect(vera.page.url()).toBe(address);
  expect(vera.complaints).toEqual([]);
  proxy.stop();
});

/** Drops files on the page, at a place on the screen. */
const drop = (page: Page, files: { name: string; bytes: Buffer }[], x = 0, y = 0) =>
  page.evaluate(
    ({ dropped, x, y }) => {
      const dataTransfer = new DataTransfer();
      for (const { name, base64 } of dropped) {
        const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
        dataTransfer.items.add(new File([bytes], name));
      }
      const place = { clientX: x, clientY: y };
      window.dispatchEvent(new DragEvent('drop', { dataTransfer, cancelable: true, ...place }));
    },
    { dropped: files.map(({ name, bytes }) => ({ name, base64: bytes.toString('base64') })), x, y },
  );

const ballAndCat = () => [
  { name: 'ball.stl', bytes: ball(8) },
  { name: 'cat.png', bytes: stripes(64) },
];

/** Counts the presses of the user from now on. */
const countClicks = (page: Page) =>
  page.evaluate(() => {
    const counter = window as unknown as { clicks: number };
    counter.clicks = 0;
    window.addEventListener(
      'click',
      ({ isTrusted }) => (counter.clicks += Number(isTrusted)),
      true,
    );
  });
const clicksOn = (page: Page): Promise<number> =>
  page.evaluate(() => (window as unknown as { clicks: number }).clicks);

test.each([1280, 390])(
  'from the drop of an STL and a picture to the pages in four clicks (%i px)',
  async (width) => {
    const person = await come(there, 'mia', '', width);
    const { page } = person;
    await page.getByText('Drop a model here').waitFor();
    await countClicks(page);
    await drop(page, ballAndCat());
    await page.getByRole('button', { name: 'Simulate' }).click();
    await page.getByRole('button', { name: 'Create PDF' }).click({ timeout: 240_000 });
    const link = page.getByRole('link', { name: 'print.pdf' });
    await link.waitFor({ timeout: 120_000 });
    const download = page.waitForEvent('download');
    await link.click();
    const { samples, channels } = imageIn(readFileSync(await (await download).path()));
    expect(await clicksOn(page)).toBeLessThanOrEqual(4);
    // The stripes are red and blue: one of these channels is dark in them.
    let dark = 0;
    for (let i = 0; i < samples.length; i += channels)
      if (Math.min(samples[i]!, samples[i + 2]!) < 100) dark += 1;
    // The ball's shadow covers about 200 mm^2 at 300 dpi.
    expect(dark).toBeGreaterThan(5000);
    expect(person.complaints).toEqual([]);
  },
);

rareTest('a picture that is dropped on the object lands there, and can be dragged', async () => {
  const person = await come(there, 'mia');
  const { page } = person;
  const [model, cat] = ballAndCat();
  await drop(page, [model!]);
  await page.locator('.stage canvas').waitFor();
  const simulate = page.getByRole('button', { name: 'Simulate' });
  await simulate.waitFor();
  const { x, y, width, height } = (await page.locator('.stage').boundingBox())!;
  const middle = [x + width / 2, y + height / 2] as const;
  // The view is loaded after the object. Before that, the picture becomes a texture.
  await expect
    .poll(
      async () => {
        await drop(page, [cat!], ...middle);
        return page.getByRole('radio', { name: 'Sticker' }).isChecked();
      },
      { timeout: 20_000 },
    )
    .toBe(true);
  expect(await page.getByRole('radio', { name: 'Picture' }).isChecked()).toBe(true);
  await page.getByRole('button', { name: 'Close-up' }).click();
  await look(person, 'new-print-sticker');
  await page.getByText('More', { exact: true }).click();
  const position = () => page.getByLabel('Position x').inputValue();
  const before = await position();
  await page.mouse.move(...middle);
  await page.mouse.down();
  await page.mouse.move(middle[0] + 8, middle[1], { steps: 4 });
  await page.mouse.up();
  const after = await position();
  expect(after).not.toBe(before);
  await page.keyboard.press('Control+z');
  await expect.poll(position).toBe(before);
  await page.keyboard.press('Control+Shift+z');
  await expect.poll(position).toBe(after);

  const sent = page.waitForRequest(
    (request) => /\/v1\/jobs\b/.test(request.url()) && request.method() === 'POST',
  );
  await simulate.click();
  const { simulate: spec } = (await sent).postDataJSON() as { simulate: { paint: object } };
  expect(spec.paint).toMatchObject({ layers: [{ projection: 'decal' }] });
  await page.locator('.film-viewer canvas').waitFor({ timeout: 240_000 });
  await page.getByRole('link', { name: 'Run again with changes' }).click();
  await page.locator('.stage canvas').waitFor();
  expect(await page.getByRole('radio', { name: 'Sticker' }).isChecked()).toBe(true);
  expect(await position()).toBe(after);
  expect(person.complaints).toEqual([]);
});

rareTest('while the object is turned, a preview shows coverage, stretch and warnings', async () => {
  const person = await come(there, 'mia');
  const { page } = person;
  await page
    .getByRole('button', { name: 'Start over' })
    .or(page.locator('.intake'))
    .first()
    .waitFor();
  const { obj, mtl, png } = files();
  await page.locator('input[type=file]').first().setInputFiles([obj, mtl, png]);
  await page.getByLabel('Longest side').fill('40');
  const panel = previewOf(page);
  // The ball is dipped fully; the film reaches all of it except the part that its own shape shields.
  expect(await coverage(page)).toBeGreaterThan(60);
  await expect.poll(() => panel.locator('.problems li').count()).toBeGreaterThan(0);
  await page.getByRole('radio', { name: 'Stretch' }).check();
  await page.getByText('Stretch of the film (estimate) [×]').waitFor();
  await look(person, 'new-print-preview');

  const before = await panel.innerText();
  const asked = page.waitForResponse(/previews:compute/);
  await page.getByText('More settings').click();
  await page.getByLabel('Depth').fill('8');
  await asked;
  await expect.poll(() => panel.innerText()).not.toBe(before);
  expect(await coverage(page)).toBeLessThan(60);
  // Beside the film, the page reports that the film does not reach the object.
  await page.getByLabel('Offset to the right').fill('400');
  await panel.waitFor({ state: 'hidden' });
  await page
    .getByText(/beside the film|misses the film|does not meet/)
    .first()
    .waitFor();
  expect(person.complaints).toEqual([]);
});

rareTest('a mesh of 1,000,000 triangles previews', async () => {
  const person = await come(there, 'mia');
  const { page } = person;
  const stl = join(mkdtempSync(join(there.daemon.folder, 'ring-')), 'ring.stl');
  writeFileSync(stl, fineRing());
  await page.locator('input[type=file]').first().setInputFiles(stl);
  expect(await coverage(page)).toBeGreaterThan(50);
  await page.getByRole('radio', { name: 'Stretch' }).check();
  await look(person, 'new-print-fine-mesh');
  expect(person.complaints).toEqual([]);
});

rareTest(
  'a GLB is read in metres with its embedded texture, on the page and by the worker',
  async () => {
    const person = await come(there, 'mia');
    const { page } = person;
    await page
      .locator('input[type=file]')
      .setInputFiles([{ name: 'ball.glb', mimeType: 'model/gltf-binary', buffer: ballGlb() }]);
    await page.locator('.stage canvas').waitFor();
    expect(await page.getByLabel('Longest side').inputValue()).toBe('60');
    expect(await page.getByLabel('One unit is').inputValue()).toBe('1000');
    expect(await page.getByRole('radio', { name: 'm', exact: true }).isChecked()).toBe(true);
    expect(await coverage(page)).toBeGreaterThan(0);
    await look(person, 'new-print-glb');
    await page.getByLabel('Resolution').selectOption('150 dpi');
    await page.getByText('More settings').click();
    await page.getByLabel('Depth').fill('6');
    await page.getByLabel('Simulation model').selectOption('MODEL_STOKES');
    await page.getByRole('button', { name: 'Simulate' }).click();
    await page.locator('.film-viewer canvas').waitFor({ timeout: 240_000 });
    expect(person.complaints).toEqual([]);
  },
);

rareTest('running again with changes starts from the settings of the job', async () => {
  const person = await come(there, 'mia', 'jobs/1');
  const { page } = person;
  await page.getByRole('link', { name: 'Run again with changes' }).click();
  await page.locator('.stage canvas').waitFor();
  expect(await page.getByLabel('Longest side').inputValue()).toBe('30');
  expect(await page.getByLabel('Rotation about z').inputValue()).toBe('30');
  await page.getByLabel('Resolution').selectOption('300 dpi');
  await page.getByRole('button', { name: 'Simulate' }).click();
  await page.waitForURL(/#\/jobs\/\d+$/);
  await page.locator('.film-viewer canvas').waitFor({ timeout: 240_000 });
  await page.getByRole('button', { name: 'Create PDF' }).click();
  await page.waitForURL(/#\/jobs\/\d+$/);
  await page.getByRole('link', { name: 'print.pdf' }).waitFor({ timeout: 60_000 });
  await look(person, 'job-pages');
});

rareTest('a job shows its progress; a cancelled job says so and can be retried', async () => {
  const person = await come(there, 'mia', 'jobs');
  const { page } = person;
  // The first job again at a higher resolution, which takes longer.
  await page.locator('.jobs').getByRole('link', { name: 'ball' }).first().waitFor();
  await open(person, '/?from=jobs/1');
  await page.locator('.stage canvas').waitFor();
  await page.getByLabel('Resolution').selectOption('600 dpi');
  await page.getByRole('button', { name: 'Simulate' }).click();
  await page.getByRole('progressbar').waitFor({ timeout: 60_000 });
  await look(person, 'job-underway');
  await page.getByRole('button', { name: 'Cancel' }).click();
  await page.getByRole('button', { name: 'Confirm cancellation' }).click();
  await page.locator('h1', { hasText: 'cancelled' }).waitFor({ timeout: 30_000 });
  await look(person, 'job-cancelled');
  const cancelled = page.url();
  await page.getByRole('button', { name: 'Retry' }).click();
  await expect.poll(() => page.url()).not.toBe(cancelled);
  await page.getByText(/retry of/).waitFor();
  await page.getByRole('button', { name: 'Cancel' }).click();
  await page.getByRole('button', { name: 'Confirm cancellation' }).click();
  await page.locator('h1', { hasText: 'cancelled' }).waitFor({ timeout: 30_000 });
  expect(person.complaints).toEqual([]);
});

rareTest('unusable files are refused, each with a reason and a remedy', async () => {
  const person = await come(there, 'mia');
  const { page } = person;
  const made = (name: string, text: string) => ({
    name,
    mimeType: 'application/octet-stream',
    buffer: Buffer.from(text),
  });
  const problems = page.locator('.problems');
  await page.evaluate(() => {
    const dataTransfer = new DataTransfer();
    dataTransfer.items.add(new File(['PK'], 'all of it.zip'));
    window.dispatchEvent(new DragEvent('drop', { dataTransfer, cancelable: true }));
  });
  await problems.getByText('all of it.zip').waitFor();
  await problems.getByText('Unpack it').waitFor();
  await page
    .locator('input[type=file]')
    .setInputFiles([
      made('part.step', 'ISO-10303-21;'),
      made('picture.png', '<svg onload=alert(1)>'),
      made('<img src=x onerror=alert(1)>.obj', 'v 0 0 0\nf 1 2 3\n'),
    ]);
  await problems.getByText('part.step').waitFor();
  await problems.getByText('Export the model as STL, PLY or OBJ').waitFor();
  expect(await page.locator('.problems img').count()).toBe(0);
  await page.locator('input[type=file]').setInputFiles([made('short.obj', 'v 0 0 0\nf 1 2 3\n')]);
  await problems.getByText(/line 2/).waitFor();
  await look(person, 'new-print-refused');
  expect(await page.getByRole('button', { name: 'Simulate' }).count()).toBe(0);
  expect(person.complaints).toEqual([]);
});

rareTest('a picture waits for its model; a missing texture blocks the simulation', async () => {
  const person = await come(there, 'mia');
  const { page } = person;
  const { obj, mtl, png } = files();
  const put = (names: string[]) => page.locator('input[type=file]').setInputFiles(names);
  await put([png]);
  await page.getByText('ball.png waits for a model').waitFor();
  await look(person, 'new-print-waiting');
  await put([obj, mtl]);
  await page.locator('.stage canvas').waitFor();
  const simulate = page.getByRole('button', { name: 'Simulate' });
  expect(await simulate.isEnabled()).toBe(true);

  await page.getByRole('button', { name: 'Start over' }).click();
  await put([obj, mtl]);
  await page
    .getByText('Add "ball.png", which the model names, or choose another texture')
    .waitFor();
  expect(await simulate.isDisabled()).toBe(true);
  await look(person, 'new-print-missing');
  await put([png]);
  await page.getByText('Computes the film image').waitFor();
  expect(await simulate.isEnabled()).toBe(true);

  await page.getByRole('button', { name: 'Start over' }).click();
  await put([png]);
  await page.getByText('ball.png waits for a model').waitFor();
  await page
    .locator('input[type=file]')
    .setInputFiles([{ name: 'leaf.stl', mimeType: 'model/stl', buffer: leaf() }]);
  await page.getByText('The picture is projected from below, as the film sees').waitFor();
  await page.getByRole('radio', { name: 'Three sides' }).check();
  await page.getByLabel('Turn of the picture').fill('90');
  expect(await simulate.isEnabled()).toBe(true);
  await look(person, 'new-print-projected');
  expect(person.complaints).toEqual([]);
});

rareTest('two users see each other’s jobs; a page recovers when the daemon returns', async () => {
  const [mia, max] = [await come(there, 'mia'), await come(there, 'max', 'jobs', 390)];
  await max.page.getByRole('link', { name: 'ball' }).first().waitFor();
  const before = await max.page.locator('.jobs tbody tr').count();
  const { obj, mtl, png } = files();
  await mia.page.locator('input[type=file]').setInputFiles([obj, mtl, png]);
  await mia.page.getByLabel('Longest side').fill('25');
  await mia.page.getByRole('button', { name: 'Simulate' }).click();
  await mia.page.waitForURL(/#\/jobs\/\d+$/);
  await expect
    .poll(() => max.page.locator('.jobs tbody tr').count(), { timeout: 15_000 })
    .toBe(before + 1);

  await there.daemon.stopDaemon('kill');
  await mia.page.getByText('The connection to the daemon was lost').waitFor({ timeout: 30_000 });
  await look(mia, 'connection-lost');
  await there.daemon.startDaemon();
  await mia.page
    .getByText('The connection to the daemon was lost')
    .waitFor({ state: 'hidden', timeout: 30_000 });
  await mia.page.locator('.film-viewer canvas').waitFor({ timeout: 240_000 });
  await look(max, 'jobs');
});
