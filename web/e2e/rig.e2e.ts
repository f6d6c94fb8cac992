/** Control of the rig, and a complete dip. */
import { mkdtempSync } from 'node:fs';
import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { beforeEach, expect, test } from 'vitest';
import { addPeople, asAdmin, come } from './accounts';
import { open } from './browser';
import { look, picture } from './checks';
import { makeBall } from './models';
import { rareTest, usePlace } from './place';
import { restRig } from './rig_at_rest';

const there = usePlace(({ daemon }) => addPeople(daemon.address));
beforeEach(() => restRig(there.daemon));

const press = (page: Page, name: string | RegExp) =>
  page.getByRole('button', { name, exact: typeof name === 'string' }).click({ timeout: 60_000 });
const position_mm = async (page: Page): Promise<number> =>
  Number(/Position\s*([-\d.]+) mm/.exec(await page.locator('.figures').first().innerText())![1]);

async function becomesReady(page: Page): Promise<void> {
  await page.locator('.big', { hasText: 'Ready' }).waitFor({ timeout: 60_000 });
}

/** Takes the rig, arms and homes it. */
async function takeReady(page: Page): Promise<void> {
  await press(page, 'Take control');
  await press(page, 'Arm');
  await press(page, 'Home');
  await becomesReady(page);
}

/** Types into a field key by key, because the start of a number may be valid ("30" of "300"), and leaves the field. */
async function type(page: Page, label: string, text: string): Promise<void> {
  const field = page.getByLabel(label);
  await field.fill('');
  await field.pressSequentially(text);
  await field.blur();
}

/** Holds the focused button down until the axis is past a position. */
async function jogPast(page: Page, mm: number): Promise<void> {
  await page.keyboard.down('Space');
  let last = NaN;
  const position = async () => {
    const now = await position_mm(page);
    // On a busy machine the rig may end the jog, because the page asks for its continuation too late.
    if (now === last) {
      await page.keyboard.up('Space');
      await page.keyboard.down('Space');
    }
    last = now;
    return now;
  };
  await expect.poll(position, { timeout: 30_000, interval: 500 }).toBeGreaterThan(mm);
  await page.keyboard.up('Space');
}

test('the rig is taken, armed, homed, moved and jogged, and stopped from another screen', async () => {
  const operator = await come(there, 'otto', 'rig');
  const { page } = operator;
  await page.getByText('Disarmed').waitFor();
  await look(operator, 'rig-free');

  const other = await come(there, 'mia', 'rig', 390);
  await page.getByLabel('Purpose').fill('<b>the mug</b>');
  await takeReady(page);
  // Untrusted text is not interpreted as HTML.
  await other.page.getByText('<b>the mug</b>').waitFor();
  expect(await other.page.getByRole('button', { name: 'Move', exact: true }).count()).toBe(0);
  await look(other, 'rig-taken');

  await page.getByLabel('Move to').fill('120');
  await press(page, 'Move');
  await page.locator('.big', { hasText: 'Moving' }).waitFor();
  // Stop from another screen, without the lease.
  await open(other, '/');
  await press(other.page, 'Stop');
  await becomesReady(page);
  const stopped = await position_mm(page);
  expect(stopped).toBeLessThan(110);

  const down = page.getByRole('button', { name: 'Down' });
  await down.focus();
  await page.keyboard.down('Space');
  await expect.poll(() => position_mm(page), { timeout: 20_000 }).toBeGreaterThan(stopped + 1);
  await page.keyboard.up('Space');
  await becomesReady(page);
  const rest = await position_mm(page);
  await page.waitForTimeout(700);
  expect(await position_mm(page)).toBeCloseTo(rest, 1);
  await look(operator, 'rig-commands');

  // A reload keeps the lease.
  await page.reload();
  await page.getByText('You control the rig').waitFor();
  await page.getByLabel('Move to').fill('20');
  await press(page, 'Move');
  await page.locator('.big', { hasText: 'Moving' }).waitFor();
  await page.keyboard.press('Escape');
  await becomesReady(page);
  await press(page, 'Release the rig');
  await page.getByRole('heading', { name: 'Take control' }).waitFor();
  expect(operator.complaints.concat(other.complaints)).toEqual([]);
});

rareTest('a number out of range stays as typed, and nothing moves', async () => {
  const person = await come(there, 'otto', 'rig');
  const { page } = person;
  const target = page.getByLabel('Move to');
  const move = page.getByRole('button', { name: 'Move', exact: true });
  const error = page.getByText('Enter 2 to 298 mm.');
  await takeReady(page);
  const rest = await position_mm(page);

  await type(page, 'Move to', '300');
  await page.getByText('Out of range. Enter 2 to 298 mm.').waitFor();
  expect(await target.inputValue()).toBe('300');
  expect(await target.getAttribute('aria-invalid')).toBe('true');
  expect(await move.isDisabled()).toBe(true);
  await look(person, 'rig-out-of-range');
  for (const text of ['298.1', '1.9', '-5', '1,000', '3O']) {
    await type(page, 'Move to', text);
    await error.waitFor();
    expect(await target.inputValue()).toBe(text);
    expect(await move.isDisabled(), text).toBe(true);
  }
  expect(await position_mm(page)).toBeCloseTo(rest, 2);

  // The typed number also stays unchanged while the axis is jogged.
  await type(page, 'Move to', '300');
  const down = page.getByRole('button', { name: 'Down' });
  await down.focus();
  await jogPast(page, rest + 1);
  await becomesReady(page);
  await error.waitFor();
  expect(await target.inputValue()).toBe('300');
  expect(await move.isDisabled()).toBe(true);

  await type(page, 'Move to', '');
  await error.waitFor({ state: 'detached' });
  expect(await move.isDisabled()).toBe(true);
  await type(page, 'Move to', '30,25');
  expect(await target.inputValue()).toBe('30,25');
  await press(page, 'Move');
  await expect.poll(() => position_mm(page), { timeout: 30_000 }).toBe(30.25);
  await becomesReady(page);
  expect(person.complaints).toEqual([]);
});

test('the commands stay while the rig is ours, and end with the lease', async () => {
  const person = await come(there, 'otto', 'rig');
  const { page } = person;
  // A state from before the lease was taken arrives after it.
  const before = await (await page.request.get(`${there.daemon.address}/v1/rig`)).text();
  await page.route('**/v1/rig', (route) => route.fulfill({ body: before }), { times: 1 });
  await press(page, 'Take control');
  await page.getByRole('heading', { name: 'You control the rig' }).waitFor();
  await press(page, 'Arm');
  await page.getByRole('button', { name: 'Home' }).waitFor();
  const admin = await asAdmin(there.daemon.address);
  await admin('POST', 'rig/lease:break', { reason: 'the rig is needed' });
  await page.getByText('Your lease of the rig has ended').waitFor();
  await page.getByRole('button', { name: 'Take control' }).waitFor();
  expect(await page.getByRole('button', { name: 'Home' }).count()).toBe(0);
  expect(person.complaints).toEqual([]);
});

test('a stop that the drive does not obey is loud on every screen, until its cause is gone', async () => {
  const operator = await come(there, 'otto', 'rig');
  const viewer = await come(there, 'vera', 'jobs', 390);
  const { page } = operator;
  const title = 'Press the stop button on the rig';
  const alertOf = (on: Page) => on.getByRole('alertdialog', { name: title });
  const bannerOf = (on: Page) => on.getByRole('alert').filter({ hasText: 'must be pressed' });
  await takeReady(page);
  await page.getByLabel('Move to').fill('250');
  await press(page, 'Move');
  await page.locator('.big', { hasText: 'Moving' }).waitFor();
  await there.daemon.act('press deaf');
  await press(page, 'Stop');
  for (const person of [operator, viewer]) {
    const on = person.page;
    await alertOf(on).waitFor();
    // A key that is held or typed at this moment acknowledges nothing.
    for (const key of ['Space', 'Enter', 'Escape', 'Escape']) await on.keyboard.press(key);
    expect(await alertOf(on).evaluate((shown) => shown.contains(document.activeElement))).toBe(
      true,
    );
    const box = await alertOf(on).boundingBox();
    expect(box).toEqual({ x: 0, y: 0, ...on.viewportSize() });
  }
  await look(operator, 'stop-alarm-rig');
  await look(viewer, 'stop-alarm-jobs');

  // Each page is silenced by its own user, and keeps the banner on every screen.
  await press(page, 'I have pressed it');
  await bannerOf(page).waitFor();
  expect(await alertOf(page).count()).toBe(0);
  expect(await alertOf(viewer.page).isVisible()).toBe(true);
  await page.locator('.big', { hasText: 'Fault' }).waitFor();
  await page.getByText(/^Alarm 48 of the drive: communication timeout/).waitFor();
  await look(operator, 'stop-alarm-banner-rig');
  await open(operator, '/jobs');
  await page.getByRole('heading', { name: 'Jobs' }).waitFor();
  expect(await bannerOf(page).isVisible()).toBe(true);
  await look(operator, 'stop-alarm-banner-jobs');

  await there.daemon.act('clear');
  await open(operator, '/rig');
  for (const step of ['Reset', 'Arm', 'Home']) await press(page, step);
  await becomesReady(page);
  await bannerOf(page).waitFor({ state: 'detached' });
  await alertOf(viewer.page).waitFor({ state: 'detached' });
  expect(operator.complaints.concat(viewer.complaints)).toEqual([]);
});

rareTest(
  'the depth camera is shown live to every user, and a missing picture is reported',
  async () => {
    const person = await come(there, 'vera', 'rig');
    const { page } = person;
    let asked = 0;
    page.on('request', (request) => (asked += request.url().includes('depthPicture') ? 1 : 0));
    const shown = page.getByRole('img', { name: /^Depth over the vat at .* mm from the camera/ });
    await shown.waitFor({ timeout: 60_000 });
    // The picture uses both ends of viridis: violet and yellow.
    const colours = await shown.evaluate((canvas: HTMLCanvasElement) => {
      const { data } = canvas.getContext('2d')!.getImageData(0, 0, canvas.width, canvas.height);
      const found = { violet: 0, yellow: 0 };
      for (let i = 0; i < data.length; i += 4) {
        const [r, g, b] = [data[i]!, data[i + 1]!, data[i + 2]!];
        if (b > 2 * g) found.violet += 1;
        if (g > 2 * b && r > 2 * b) found.yellow += 1;
      }
      return found;
    });
    expect(colours.violet).toBeGreaterThan(100);
    expect(colours.yellow).toBeGreaterThan(100);
    const first = await shown.getAttribute('aria-label');
    await expect.poll(() => shown.getAttribute('aria-label'), { timeout: 20_000 }).not.toBe(first);
    await look(person, 'rig-depth');

    await there.daemon.act('camera gone');
    await page.getByText(/No picture since .*plug/).waitFor({ timeout: 30_000 });
    await look(person, 'rig-depth-gone');
    await there.daemon.act('clear');
    await page.getByText('No picture since').waitFor({ state: 'hidden', timeout: 30_000 });

    await open(person, '/jobs');
    await page.getByRole('heading', { name: 'Jobs' }).waitFor();
    const before = asked;
    await page.waitForTimeout(2500);
    expect(asked, 'requests after leaving the screen').toBe(before);
    expect(person.complaints).toEqual([]);
  },
);

test('a dip is guided step by step with one large button', async () => {
  const person = await come(there, 'otto');
  const { page } = person;
  const { obj, mtl, png } = makeBall(mkdtempSync(join(there.daemon.folder, 'model-')));
  await page.locator('input[type=file]').setInputFiles([obj, mtl, png]);
  await page.getByLabel('Longest side').fill('30');
  await page.getByText('More settings').click();
  await type(page, 'Depth', '40000');
  await page.getByText('Out of range. Enter 0.001 to 10000 mm.').waitFor();
  await page.getByText('Correct “Depth” first').waitFor();
  const compute = page.getByRole('button', { name: 'Simulate' });
  expect(await compute.isDisabled()).toBe(true);
  expect(await page.getByLabel('Depth').inputValue()).toBe('40000');
  await look(person, 'new-print-out-of-range');
  await page.getByLabel('Depth').fill('4');
  await page.getByLabel('Simulation model').selectOption('MODEL_STOKES');
  await page.getByLabel('Resolution').selectOption('150 dpi');
  await press(page, 'Simulate');
  await page.getByRole('link', { name: 'Dip', exact: true }).click({ timeout: 240_000 });

  await takeReady(page);
  await page.getByText('Dip settings').click();
  const begin = page.getByRole('button', { name: 'Start the dip' });
  await type(page, 'Soak time', '36000');
  await page.getByText('Out of range. Enter 0 to 3600 s.').waitFor();
  await page.getByText('Correct “Soak time” first.').waitFor();
  expect(await begin.isDisabled()).toBe(true);
  expect(await page.getByLabel('Soak time').inputValue()).toBe('36000');
  await look(person, 'rig-dip-out-of-range');
  await page.getByLabel('Soak time').fill('3');
  await page.getByLabel('Activation time').fill('2');
  await page.getByLabel('Hold time at depth').fill('1');
  await look(person, 'rig-dip-begin');
  await press(page, 'Start the dip');
  await press(page, 'The film is printed');
  await press(page, 'The object is mounted');
  await page.getByText(/step 3 of 12/).waitFor();
  const down = page.getByRole('button', { name: 'Down' });
  await page.getByRole('radio', { name: '10 mm/s' }).check();
  await down.focus();
  await jogPast(page, 45);
  await becomesReady(page);
  await look(person, 'rig-dip-contact');
  await press(page, 'The object almost touches the water');
  await press(page, 'The film floats between the bars');
  await page.getByRole('timer').first().waitFor();
  await picture(person, 'rig-dip-soak');
  await press(page, 'The activator is sprayed');
  await page.getByText(/The film can be used for/).waitFor();
  await press(page, 'Hands are clear: dip now');
  await page.locator('.big', { hasText: 'Dipping' }).waitFor();
  await picture(person, 'rig-dipping');
  await page.getByText('The dip has ended').waitFor({ timeout: 60_000 });
  await look(person, 'rig-dip-end');
  await page.getByRole('link', { name: 'Dip record' }).click();
  await page.locator('h1', { hasText: 'done' }).waitFor();
  await page.getByRole('link', { name: 'positions.csv' }).waitFor();
  await look(person, 'job-dip');
  expect(person.complaints).toEqual([]);
});
