/** What people experience while a model is uploaded, read, shown and previewed. */
import { mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import type { CDPSession, Page } from 'playwright-core';
import { expect } from 'vitest';
import { addPeople, come } from './accounts';
import type { Person } from './browser';
import { look } from './checks';
import { coverage, makeManyTextures, makeWaves } from './models';
import { rareTest, usePlace } from './place';
import { ball, fineRing } from './solids';

const there = usePlace(({ daemon }) => addPeople(daemon.address));

const folder = () => mkdtempSync(join(there.daemon.folder, 'model-'));
const kSmall = { around: 48, down: 24 };
/** 5 MB, 85,000 triangles. */
const kLarge = { around: 294, down: 146 };
const small = (name: string, waves = 5) => makeWaves(folder(), { ...kSmall, waves, name });

const choose = (page: Page, files: string[]) =>
  page.locator('input[type=file]').first().setInputFiles(files);

/** Adds comments to an OBJ, so that its upload takes several chunks. */
function lengthen(obj: string, bytes: number): void {
  writeFileSync(obj, `${readFileSync(obj, 'utf8')}${`#${'x'.repeat(98)}\n`.repeat(bytes / 100)}`);
}

/** Number of pixels of the 3D view that have the colour of the models here. */
async function magentaPixels(page: Page): Promise<number> {
  const png = await page.locator('.stage canvas').screenshot();
  return page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
    const picture = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
    const context = new OffscreenCanvas(picture.width, picture.height).getContext('2d')!;
    context.drawImage(picture, 0, 0);
    const { data } = context.getImageData(0, 0, picture.width, picture.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4)
      if (data[i]! > 60 && data[i]! > 2 * data[i + 1]! && data[i + 2]! > 2 * data[i + 1]!)
        count += 1;
    return count;
  }, png.toString('base64'));
}

/** Waits until the object is visible in the 3D view. */
async function seesObject(page: Page, timeout = 60_000): Promise<void> {
  await page.locator('.stage canvas').waitFor({ timeout });
  await expect.poll(() => magentaPixels(page), { timeout }).toBeGreaterThan(3000);
}

/** Bytes per second; undefined: as fast as possible. */
interface Speed {
  up?: number;
  down?: number;
}

async function throttle(cdp: CDPSession, { up = -1, down = -1 }: Speed): Promise<void> {
  await cdp.send('Network.emulateNetworkConditions', {
    offline: false,
    latency: 0,
    uploadThroughput: up,
    downloadThroughput: down,
  });
}

const reading = (page: Page) => page.locator('.reading');

/** What the panel says, without the figure that differs each time. */
const panelText = async (page: Page): Promise<string> =>
  (await page.locator('.panel').innerText()).replace(/Computing time\s+\S+ \S+/, '');

/** Slows the network of a page. */
async function slowed(person: Person): Promise<(speed: Speed) => Promise<void>> {
  const cdp = await person.context.newCDPSession(person.page);
  await cdp.send('Network.enable');
  return (speed) => throttle(cdp, speed);
}

rareTest(
  'while a model is uploaded and read, the page says so, and Cancel leaves the page as it was',
  async () => {
    const person = await come(there, 'mia');
    const { page } = person;
    const run = await slowed(person);
    const [first, second] = [small('first'), small('second', 9)];
    lengthen(first[0]!, 3e6);
    const progress = reading(page).getByRole('progressbar');
    const value = async () => Number((await progress.getAttribute('value')) ?? NaN);

    await run({ up: 150e3 });
    await choose(page, first);
    await reading(page).getByText('Uploading first.obj').waitFor();
    await expect.poll(value, { timeout: 30_000 }).toBeGreaterThan(0.1);
    expect(await value()).toBeLessThan(0.9);
    await look(person, 'model-uploading');
    await reading(page).getByRole('button', { name: 'Cancel' }).click();
    await page.getByText('Drop a model here').waitFor();
    expect(await reading(page).count()).toBe(0);
    expect(await page.locator('.stage, .problems li, .files li').count()).toBe(0);

    await run({});
    await choose(page, first);
    await seesObject(page);
    await coverage(page);
    const before = await panelText(page);
    const pixels = await magentaPixels(page);
    const isAsBefore = async () => {
      await expect.poll(() => reading(page).count()).toBe(0);
      await expect.poll(() => panelText(page)).toBe(before);
      expect(Math.abs((await magentaPixels(page)) - pixels)).toBeLessThan(0.01 * pixels);
    };

    // Another model, while the first is shown.
    lengthen(second[0]!, 3e6);
    await run({ up: 150e3 });
    await choose(page, second);
    await reading(page).getByText('Uploading second.obj').waitFor();
    expect(await magentaPixels(page)).toBeGreaterThan(3000);
    await look(person, 'model-uploading-another');
    await reading(page).getByRole('button', { name: 'Cancel' }).click();
    await isAsBefore();

    // The same, but cancelled while the daemon's answer arrives.
    await run({ down: 2000 });
    await choose(page, second);
    await reading(page).getByText('Reading the model').waitFor();
    expect(await progress.count()).toBe(1);
    expect(await value()).toBeNaN();
    await look(person, 'model-reading');
    await reading(page).getByRole('button', { name: 'Cancel' }).click();
    await run({});
    await isAsBefore();

    await choose(page, second);
    await page.locator('.files').getByText('second.obj').waitFor();
    await seesObject(page);
    await coverage(page);
    expect(await page.locator('.files').getByText('first.obj').count()).toBe(0);
    expect(person.complaints).toEqual([]);
  },
);

/** Kills the daemon and starts it again after `work`. */
async function withoutDaemon(work: () => Promise<void>): Promise<void> {
  await there.daemon.stopDaemon('kill');
  try {
    await work();
  } finally {
    await there.daemon.startDaemon();
  }
}

rareTest('a page that is open while the daemon restarts goes on by itself', async () => {
  const person = await come(there, 'mia');
  const { page } = person;
  await page.getByText('Drop a model here').waitFor();

  await withoutDaemon(async () => {
    await choose(page, small('patient', 6));
    await reading(page)
      .getByText('Connection lost; the upload of patient.obj will resume')
      .waitFor();
    await page.getByText('The connection to the daemon was lost').waitFor();
    await look(person, 'model-no-daemon');
  });
  await seesObject(page);
  expect(await coverage(page)).toBeGreaterThan(0);

  // The daemon ends while it reads a model, whose files it has.
  const asked = page.waitForRequest(/models:read/);
  await choose(page, makeWaves(folder(), { ...kLarge, waves: 7, name: 'interrupted' }));
  await asked;
  await withoutDaemon(async () => {
    await reading(page).getByText('The daemon does not answer; waiting until it does').waitFor();
  });
  await page.locator('.files').getByText('interrupted.obj').waitFor({ timeout: 60_000 });
  await seesObject(page);
  expect(await coverage(page)).toBeGreaterThan(0);

  // The daemon ends while a preview is shown; then the object is turned.
  await withoutDaemon(async () => {
    await page.getByLabel('Rotation about x').fill('90');
    await page.getByText('No preview: The daemon does not answer; waiting until it does').waitFor();
    await look(person, 'model-no-preview');
  });
  const answer = page.waitForResponse((response) => /previews:compute/.test(response.url()));
  expect(await coverage(page)).toBeGreaterThan(0);
  expect((await answer).request().postDataJSON()).toMatchObject({
    simulate: {
      pose: { rotationWxyz: [expect.closeTo(Math.SQRT1_2), expect.closeTo(Math.SQRT1_2), 0, 0] },
    },
  });
  expect(person.complaints).toEqual([]);
});

const kDamaged = 'v 0 0 0\nv 40 0 0\nv 0 40 9\nf 1 2 9\n';
const kCoatless = [
  ...['ply', 'format ascii 1.0', 'comment TextureFile coat.png', 'element vertex 3'],
  ...['x', 'y', 'z', 's', 't'].map((name) => `property float ${name}`),
  ...['element face 1', 'property list uchar int vertex_indices', 'end_header'],
  ...['0 0 0 0 0', '40 0 0 1 0', '0 40 9 0 1', '3 0 1 2', ''],
].join('\n');
const file = (name: string, content: string | Buffer) => {
  const path = join(folder(), name);
  writeFileSync(path, content);
  return path;
};

rareTest(
  'a refused model is named with the next step, and the page takes a good one then',
  async () => {
    const person = await come(there, 'mia');
    const { page } = person;
    const problems = page.locator('.problems li');
    const simulate = page.getByRole('button', { name: 'Simulate' });

    await choose(page, [file('damaged.obj', kDamaged)]);
    await problems.filter({ hasText: /damaged\.obj.*line 4/ }).waitFor();
    expect(await problems.allInnerTexts()).toEqual([expect.stringContaining('export it again')]);
    // Words for people: the name once, and not the program's.
    const [damaged] = await problems.allInnerTexts();
    expect.soft(damaged).not.toContain('hydroprint-worker');
    expect.soft(damaged!.match(/damaged\.obj/g)).toHaveLength(1);
    await look(person, 'model-damaged');
    expect(await simulate.count()).toBe(0);

    await choose(page, [file('coatless.ply', kCoatless)]);
    await problems.filter({ hasText: 'coat.png' }).first().waitFor();
    expect(await problems.allInnerTexts()).toEqual([
      expect.stringMatching(/coat\.png.*Add it, or choose another texture/),
    ]);
    expect(await problems.getByText('damaged.obj').count()).toBe(0);
    await page
      .getByText('Add "coat.png", which the model names, or choose another texture')
      .waitFor();
    expect(await simulate.isDisabled()).toBe(true);
    await look(person, 'model-coatless');

    await choose(page, [file('plain.stl', ball())]);
    await page.locator('.files').getByText('plain.stl').waitFor();
    await coverage(page);
    // The worker would refuse the simulation, because the film would stay blank.
    expect.soft(await simulate.isDisabled()).toBe(true);
    expect.soft(await page.locator('.submit').innerText()).toMatch(/picture|texture/);
    await look(person, 'model-plain');

    await choose(page, small('good'));
    await page.locator('.files').getByText('good.obj').waitFor();
    await seesObject(page);
    await coverage(page);
    expect(await simulate.isEnabled()).toBe(true);
    expect(
      await page
        .locator('.panel')
        .getByText(/damaged|coat|plain/)
        .count(),
    ).toBe(0);
    expect(person.complaints).toEqual([]);
  },
);

rareTest('200 textures are shown; 500 are refused in words', async () => {
  const person = await come(there, 'mia');
  const { page } = person;
  await choose(page, makeManyTextures(folder(), 200));
  await seesObject(page);
  expect(await coverage(page)).toBeGreaterThan(0);
  expect(await page.getByRole('button', { name: 'Simulate' }).isEnabled()).toBe(true);
  await look(person, 'model-200-textures');

  await choose(page, makeManyTextures(folder(), 500));
  const problem = page.locator('.problems li').filter({ hasText: 'strips.obj' });
  await problem.waitFor({ timeout: 60_000 });
  const words = await problem.innerText();
  await look(person, 'model-500-textures');
  expect(words).toMatch(/256/);
  expect.soft(words, 'a name of the API').not.toMatch(/extra_files/);
  // The first object is still there.
  expect(await magentaPixels(page)).toBeGreaterThan(3000);
  expect(person.complaints).toEqual([]);
});

rareTest('a file that changes on the disk meanwhile is refused in words', async () => {
  const person = await come(there, 'mia');
  const { page } = person;
  const run = await slowed(person);
  await run({ up: 150e3 });
  const files = small('changing');
  const other = readFileSync(small('changing', 9)[0]!);
  lengthen(files[0]!, 3e6);
  const progress = reading(page).getByRole('progressbar');
  await choose(page, files);
  await expect
    .poll(async () => Number(await progress.getAttribute('value')), { timeout: 30_000 })
    .toBeGreaterThan(0.1);
  writeFileSync(files[0]!, other);
  await run({});
  const problem = page.locator('.problems li').filter({ hasText: 'changing.obj' });
  await problem.getByText('Choose the file again').waitFor({ timeout: 30_000 });
  expect.soft((await problem.innerText()).match(/changing\.obj/g)).toHaveLength(1);
  await look(person, 'model-changed');
  await choose(page, files);
  await seesObject(page);
  await coverage(page);

  // The file changes after its model was shown. Simulate must not send the new one.
  writeFileSync(files[0]!, readFileSync(small('changing', 3)[0]!));
  await page.getByRole('button', { name: 'Simulate' }).click();
  await page.locator('.submit').getByText('Choose the file again').waitFor();
  await look(person, 'model-changed-since');
  expect(person.complaints).toEqual([]);
});

rareTest('running again with changes shows the same object, and its preview', async () => {
  const person = await come(there, 'mia');
  const { page } = person;
  await choose(page, small('again', 4));
  await seesObject(page);
  const pixels = await magentaPixels(page);
  const before = await coverage(page);
  const size = await page.getByText(/^Size:/).innerText();
  await page.getByLabel('Resolution').selectOption('150 dpi');
  await page.getByRole('button', { name: 'Simulate' }).click();
  await page.locator('.film-viewer canvas').waitFor({ timeout: 240_000 });
  await page.getByRole('link', { name: 'Run again with changes' }).click();
  await page.getByText(/Same object as in job/).waitFor();
  await seesObject(page);
  expect(await coverage(page)).toBe(before);
  expect(Math.abs((await magentaPixels(page)) - pixels)).toBeLessThan(0.01 * pixels);
  expect(await page.getByText(/^Size:/).innerText()).toBe(size);
  await look(person, 'model-again');

  // A reload keeps it.
  await page.reload();
  await seesObject(page);
  expect(await coverage(page)).toBe(before);
  expect(person.complaints).toEqual([]);
});

rareTest('two people read the same model at once', async () => {
  const people = [await come(there, 'mia'), await come(there, 'max')];
  const files = small('shared', 8);
  await Promise.all(people.map(({ page }) => choose(page, files)));
  const seen = await Promise.all(
    people.map(async ({ page }) => {
      await seesObject(page);
      return coverage(page);
    }),
  );
  expect(seen[0]).toBeGreaterThan(0);
  expect(seen[1]).toBe(seen[0]);
  for (const { complaints } of people) expect(complaints).toEqual([]);
});

/** What watch() notes; ms since the page's time origin. */
interface Watched {
  /** The last time that files were chosen. */
  chosen: number;
  /** The first picture since then that has the object, drawn and handed to the browser. */
  seen: number;
  /** The first coverage since then. */
  previewed: number;
}

/** Notes when files are chosen, when the object is first drawn after that, and when its preview is there. Runs in the page. */
function watch(): void {
  // The film, the water and the handles have fewer corners.
  const kCorners = 50_000;
  const times = { chosen: 0, seen: 0, previewed: 0 };
  (window as unknown as { watched: Watched }).watched = times;
  window.addEventListener(
    'change',
    (event) => {
      if ((event.target as HTMLInputElement).type === 'file')
        Object.assign(times, { chosen: performance.now(), seen: 0, previewed: 0 });
    },
    true,
  );
  const { prototype } = WebGL2RenderingContext;
  const { drawElements } = prototype;
  let isDrawn = false;
  prototype.drawElements = function (mode, count, type, offset) {
    drawElements.call(this, mode, count, type, offset);
    if (times.chosen === 0 || times.seen > 0 || isDrawn || count < kCorners) return;
    isDrawn = true;
    // Waits until it is drawn.
    this.readPixels(0, 0, 1, 1, this.RGBA, this.UNSIGNED_BYTE, new Uint8Array(4));
    requestAnimationFrame(() => {
      times.seen = performance.now();
      isDrawn = false;
    });
  };
  new MutationObserver(() => {
    if (times.seen === 0 || times.previewed > 0) return;
    const panel = document.querySelector('[aria-labelledby=preview-title]');
    if (panel?.textContent?.includes('Coverage')) times.previewed = performance.now();
  }).observe(document, { childList: true, subtree: true, characterData: true });
}

/** Opens the page New print with watch(), as mia. */
async function watched(): Promise<Person> {
  const person = await come(there, 'mia');
  await person.context.addInitScript(watch);
  await person.page.reload();
  await person.page.getByText('Drop a model here').waitFor();
  return person;
}

/** Chooses files, and returns the times when object and preview are there. */
async function timesOf(page: Page, files: string[]): Promise<Watched> {
  await choose(page, files);
  const get = () => page.evaluate(() => (window as unknown as { watched: Watched }).watched);
  await expect.poll(async () => (await get()).previewed, { timeout: 60_000 }).toBeGreaterThan(0);
  return get();
}

async function startOver(page: Page): Promise<void> {
  await page.getByRole('button', { name: 'Start over' }).click();
  await page.getByText('Drop a model here').waitFor();
}

const large = (waves: number) => makeWaves(folder(), { ...kLarge, waves, name: `waves${waves}` });
const inSeconds = (times_ms: number[]): string =>
  times_ms.map((time) => `${(time / 1000).toFixed(2)} s`).join(', ');

rareTest('figures: from the choice of a 5 MB OBJ to its first picture', async () => {
  const { page, complaints } = await watched();
  await timesOf(page, large(2));
  const runs: Watched[] = [];
  for (const waves of [3, 4, 5, 6, 7]) {
    const files = large(waves);
    expect(readFileSync(files[0]!).length).toBeGreaterThan(5e6);
    await startOver(page);
    runs.push(await timesOf(page, files));
    expect(await magentaPixels(page)).toBeGreaterThan(3000);
  }
  console.log(
    `5 MB OBJ, choice to picture: ${inSeconds(runs.map((run) => run.seen - run.chosen))}`,
  );
  console.log(
    `5 MB OBJ, picture to preview: ${inSeconds(runs.map((run) => run.previewed - run.seen))}`,
  );
  expect(complaints).toEqual([]);
});

rareTest(
  'figures: from the last upload of a 50 MB STL to its picture and its preview',
  async () => {
    const { page, complaints } = await watched();
    await timesOf(page, large(2));
    await startOver(page);
    let uploaded_ms = 0;
    page.on('requestfinished', (request) => {
      const { startTime, responseEnd } = request.timing();
      if (request.method() === 'PATCH') uploaded_ms = startTime + responseEnd;
    });
    const times = await timesOf(page, [file('ring.stl', fineRing())]);
    const origin_ms = await page.evaluate(() => performance.timeOrigin);
    const uploaded = uploaded_ms - origin_ms;
    expect(uploaded).toBeGreaterThan(times.chosen);
    console.log(`50 MB STL, choice to last upload: ${inSeconds([uploaded - times.chosen])}`);
    console.log(`50 MB STL, last upload to picture: ${inSeconds([times.seen - uploaded])}`);
    console.log(`50 MB STL, picture to preview: ${inSeconds([times.previewed - times.seen])}`);
    expect(complaints).toEqual([]);
  },
);

rareTest('figures: ten models of 5 MB one after another do not fill the memory', async () => {
  const { page, context, complaints } = await watched();
  const cdp = await context.newCDPSession(page);
  await cdp.send('Performance.enable');
  const used = async () => {
    for (let i = 0; i < 2; i += 1) await cdp.send('HeapProfiler.collectGarbage');
    const { metrics } = await cdp.send('Performance.getMetrics');
    const heap = metrics.find(({ name }) => name === 'JSHeapUsedSize')!.value;
    // Meshes are not part of the heap.
    const { backingStorageSize } = (await cdp.send('Runtime.getHeapUsage')) as {
      backingStorageSize?: number;
    };
    return { heap, buffers: backingStorageSize ?? NaN };
  };
  const empty = await used();
  const sizes: Awaited<ReturnType<typeof used>>[] = [];
  for (let waves = 1; waves <= 10; waves += 1) {
    await timesOf(page, large(waves));
    await page.locator('.files').getByText(`waves${waves}.obj`).waitFor();
    sizes.push(await used());
  }
  const list = (of: (size: (typeof sizes)[0]) => number) =>
    sizes.map((size) => (of(size) / 1e6).toFixed(1)).join(' ');
  const [second, tenth] = [sizes[1]!, sizes[9]!];
  const growth = (of: (size: (typeof sizes)[0]) => number) => of(tenth) - of(second);
  console.log(`JS heap after each of ten models, MB: ${list(({ heap }) => heap)}`);
  console.log(`buffers after each of ten models, MB: ${list(({ buffers }) => buffers)}`);
  const share = growth(({ heap }) => heap) / second.heap;
  console.log(`the heap grows by ${Math.round(100 * share)} % from the second to the tenth`);
  // The heap also holds compiled code, which grows at first. None of the eight models is kept.
  const model = sizes[0]!.buffers - empty.buffers;
  expect(model).toBeGreaterThan(1e6);
  expect(growth(({ heap, buffers }) => heap + buffers)).toBeLessThan(model);
  expect(complaints).toEqual([]);
});
