/** A print of two dips, from the model to the second dip, with every step from the page of its plan. */
import { existsSync, mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { beforeEach, expect } from 'vitest';
import { addPeople, come } from './accounts';
import type { Person } from './browser';
import { look, picture } from './checks';
import { root } from './daemon';
import { rareTest, usePlace } from './place';
import { restRig } from './rig_at_rest';

const there = usePlace(({ daemon }) => addPeople(daemon.address));
beforeEach(() => restRig(there.daemon));

const kLong = { timeout: 120_000 };

/** Directly at the gripper, a calibration finds no object in view. */
const kRod_mm = 20;

const kSpot = join(root, '../shared/models/spot');
const kPicture = join(kSpot, 'spot_texture.png');
const kModel = join(kSpot, 'spot_triangulated.obj');
const kUnit_mm = 35;

/** Writes the model in mm, and returns its path and the range of its y axis, along which it stands. */
function spotInMm(folder: string): { path: string; least_mm: number; most_mm: number } {
  const heights: number[] = [];
  const lines = readFileSync(kModel, 'utf8')
    .split('\n')
    .map((line) => {
      if (!line.startsWith('v ')) return line;
      const place = line.split(/\s+/).slice(1, 4).map(Number);
      heights.push(place[1]! * kUnit_mm);
      return `v ${place.map((value) => value * kUnit_mm).join(' ')}`;
    });
  const path = join(folder, 'in_mm.obj');
  writeFileSync(path, lines.join('\n'));
  return { path, least_mm: Math.min(...heights), most_mm: Math.max(...heights) };
}

/** Hangs spot below the gripper of the virtual rig, standing or on its head. */
async function hang(spot: ReturnType<typeof spotInMm>, isOver: boolean): Promise<void> {
  const held = `${spot.path}.json`;
  const top_mm = isOver ? -spot.least_mm : spot.most_mm;
  const half = Math.SQRT1_2;
  writeFileSync(
    held,
    JSON.stringify({
      rotation_wxyz: [half, isOver ? -half : half, 0, 0],
      translation_mm: [0, 0, -top_mm - kRod_mm],
    }),
  );
  await there.daemon.act(`hang ${held} ${spot.path}`);
}

const primaries = (page: Page) => page.locator('main :is(a, button).primary');

/** Presses the only primary button of the plan's page, once it is the expected one. */
async function go(page: Page, name: string | RegExp): Promise<void> {
  const only = primaries(page).filter({ hasText: name });
  await only.waitFor(kLong);
  expect(await primaries(page).count()).toBe(1);
  await only.click();
}

const press = (page: Page, name: string) =>
  page.getByRole('button', { name, exact: true }).click({ timeout: 60_000 });

/** From the start of a dip to its end. The calibration knows the position of first contact. */
async function dip(page: Page): Promise<void> {
  await page.getByText('Dip settings').click();
  await page.getByLabel('Soak time').fill('1');
  await page.getByLabel('Activation time').fill('1');
  await page.getByLabel('Hold time at depth').fill('1');
  await press(page, 'Start the dip');
  await press(page, 'The film is printed');
  await page.getByRole('img', { name: 'The planned pose' }).waitFor();
}

async function finishDip(page: Page): Promise<void> {
  await press(page, 'The object is mounted');
  await press(page, 'First contact is measured, hands are clear: go on');
  await press(page, 'The film floats between the bars');
  await press(page, 'The activator is sprayed');
  await press(page, 'Hands are clear: dip now');
  await page.getByText('The dip has ended').waitFor(kLong);
}

/** The daemon ends without a warning and comes back. The page stays open. */
async function killDaemon(person: Person): Promise<void> {
  const lost = person.page.getByText('The connection to the daemon was lost');
  await there.daemon.stopDaemon('kill');
  await lost.waitFor(kLong);
  await look(person, 'plan-connection-lost');
  await there.daemon.startDaemon();
  await lost.waitFor({ state: 'hidden', ...kLong });
}

async function prepareRig(page: Page, first: 'Take control' | 'Reset'): Promise<void> {
  for (const step of [first, 'Arm', 'Home']) await press(page, step);
  await page.locator('.big', { hasText: 'Ready' }).waitFor(kLong);
}

const dipList = (page: Page) => page.locator('.dips li');

/** Expects the previews and the depths of the dips, and a picture of each. */
async function expectDips(page: Page, depths_mm: number[]): Promise<void> {
  await expect
    .poll(() => dipList(page).allTextContents(), kLong)
    .toEqual(
      depths_mm.map((mm, k) =>
        expect.stringMatching(
          new RegExp(`^Dip ${k + 1}reach .* %, stretch .* ×, ${mm}\\smm deep$`),
        ),
      ),
    );
  await expect
    .poll(() => dipList(page).locator('canvas').evaluateAll(coloursIn), kLong)
    .toEqual(depths_mm.map(() => expect.toSatisfy((count: number) => count > 50)));
}

/** The numbers of different colours in the canvases. Runs in the page. */
const coloursIn = (canvases: Element[]): number[] =>
  canvases.map((element) => {
    const canvas = element as HTMLCanvasElement;
    const { data } = canvas.getContext('2d')!.getImageData(0, 0, canvas.width, canvas.height);
    return new Set(new Uint32Array(data.buffer)).size;
  });

/** From the model to the list of two dips, the second of them upside down. */
async function describeDips(person: Person): Promise<void> {
  const { page } = person;
  await page.getByRole('link', { name: 'New print' }).click();
  await page.locator('input[type=file]').setInputFiles([kModel, kPicture]);
  await page.locator('.stage canvas').waitFor();
  await page.getByLabel('One unit is').fill(String(kUnit_mm));
  await press(page, '+90° x');
  await page.getByLabel('Resolution').selectOption('150 dpi');
  await page.getByText('More settings').click();
  await page.getByLabel('Depth').fill('20');
  await page.getByLabel('Simulation model').selectOption('MODEL_STOKES');
  await press(page, 'Add another dip');
  await page.getByLabel('Depth of dip 2').fill('15');
  await expectDips(page, [20, 15]);
  await look(person, 'new-print-dips');
  await dipList(page).last().scrollIntoViewIfNeeded();
  await picture(person, 'new-print-dips-list');
}

/** Changes the order with the keyboard, there and back. */
async function reorder(page: Page): Promise<void> {
  await page.getByRole('button', { name: 'Move dip 1 down' }).press('Enter');
  await expectDips(page, [15, 20]);
  const focused = () => page.evaluate(() => document.activeElement?.getAttribute('aria-label'));
  expect(await focused()).toBe('Move dip 2 up');
  await page.keyboard.press('Enter');
  await expectDips(page, [20, 15]);
}

/** Before the first dip, the plan can be made again with another order. */
async function openAgain(person: Person): Promise<void> {
  const { page } = person;
  await page.getByRole('link', { name: 'Change the order or the poses' }).click();
  await page.locator('.stage canvas').waitFor();
  await expectDips(page, [20, 15]);
  await picture(person, 'new-print-again');
  await reorder(page);
  await page.goBack();
}

/** Hangs spot for the next dip, and goes from its calibration to its start. */
async function computeDip(page: Page): Promise<void> {
  await go(page, 'calibrate');
  await go(page, 'Compute the film image');
  await go(page, 'Create PDF');
  await primaries(page).filter({ hasText: /^Dip$/ }).waitFor(kLong);
}

const spotTest = existsSync(kModel) ? rareTest : rareTest.skip;

const journey = async (width: number): Promise<void> => {
  const person = await come(there, 'otto', 'rig', width);
  const { page } = person;
  const spot = spotInMm(mkdtempSync(join(there.daemon.folder, 'plan-')));
  await prepareRig(page, 'Take control');
  await describeDips(person);
  await reorder(page);
  await press(page, 'Compute 2 dips');

  for (const number of [1, 2]) {
    await page.getByRole('heading', { name: `Dip ${number} of 2` }).waitFor(kLong);
    await hang(spot, number === 2);
    if (number === 1) {
      await look(person, 'plan');
      await openAgain(person);
    } else {
      await killDaemon(person);
      await look(person, 'plan-not-homed');
      await go(page, 'Prepare the rig');
      await prepareRig(page, 'Reset');
      await picture(person, 'plan-rig');
      await page.getByRole('link', { name: 'Back to the plan' }).click();
    }
    await computeDip(page);
    await look(person, `plan-computed-${number}`);
    await go(page, /^Dip$/);
    await dip(page);
    if (number === 2) await picture(person, 'plan-dip');
    await finishDip(page);
    if (number === 2) await look(person, 'plan-dip-end');
    // The camera does not see the object while it is at the water.
    await page.getByLabel('Move to').fill('20');
    await press(page, 'Move');
    await page.getByText('20.00 mm').waitFor(kLong);
    await page.getByRole('link', { name: 'Back to the plan' }).click();
  }
  await page.getByRole('heading', { name: 'All dips are done' }).waitFor(kLong);
  expect(await primaries(page).count()).toBe(1);
  expect(await page.locator('.plan .state', { hasText: 'done' }).count()).toBe(2);
  await look(person, 'plan-done');
  expect(person.complaints).toEqual([]);
};

for (const width of [1280, 390])
  spotTest(
    `two dips of spot, with the daemon killed between them, ${width} px wide`,
    { timeout: 600_000 },
    () => journey(width),
  );
