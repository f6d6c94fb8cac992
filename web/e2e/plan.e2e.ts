/** A print of two dips, from the model to the second dip, with every step from the page of its plan. */
import { mkdtempSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { beforeEach, expect } from 'vitest';
import { addPeople, come } from './accounts';
import { look, picture } from './checks';
import { stripes } from './models';
import { rareTest, usePlace } from './place';
import { restRig } from './rig_at_rest';
import { bracket } from './solids';

const there = usePlace(({ daemon }) => addPeople(daemon.address));
beforeEach(() => restRig(there.daemon));

const kLong = { timeout: 120_000 };

/** The bracket hangs on a rod: directly at the gripper, its calibration found no object in view. */
const kRod_mm = 20;

/** Hangs the bracket below the gripper of the virtual rig, upright or turned over about x. */
async function hang(folder: string, isOver: boolean): Promise<void> {
  const held = join(folder, 'held.json');
  const top_mm = isOver ? 10 : 30;
  const rotation = isOver ? [0, 1, 0, 0] : [1, 0, 0, 0];
  writeFileSync(
    held,
    JSON.stringify({ rotation_wxyz: rotation, translation_mm: [-5, 0, -top_mm - kRod_mm] }),
  );
  await there.daemon.act(`hang ${held} ${join(folder, 'bracket.stl')}`);
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

rareTest('two dips are planned, computed for the measured poses, and dipped', async () => {
  const person = await come(there, 'otto', 'rig');
  const { page } = person;
  const folder = mkdtempSync(join(there.daemon.folder, 'plan-'));
  const files = [join(folder, 'bracket.stl'), join(folder, 'stripes.png')];
  writeFileSync(files[0]!, bracket());
  writeFileSync(files[1]!, stripes(64));
  for (const step of ['Take control', 'Arm', 'Home']) await press(page, step);
  await page.locator('.big', { hasText: 'Ready' }).waitFor(kLong);

  await page.getByRole('link', { name: 'New print' }).click();
  await page.locator('input[type=file]').setInputFiles(files);
  await page.locator('.stage canvas').waitFor();
  await page.getByLabel('Resolution').selectOption('150 dpi');
  await page.getByText('More settings').click();
  await page.getByLabel('Depth').fill('6');
  await page.getByLabel('Simulation model').selectOption('MODEL_STOKES');
  await page.getByRole('region', { name: 'Preview' }).waitFor(kLong);
  await press(page, 'Add another dip');
  await expect.poll(() => page.getByText(/reach .* stretch/).count(), kLong).toBe(2);
  await look(person, 'new-print-dips');
  await press(page, 'Compute 2 dips');

  for (const number of [1, 2]) {
    await page.getByRole('heading', { name: `Dip ${number} of 2` }).waitFor(kLong);
    await hang(folder, number === 2);
    if (number === 1) await look(person, 'plan');
    await go(page, 'calibrate');
    await go(page, 'Compute the film image');
    await go(page, 'Create PDF');
    await primaries(page).filter({ hasText: /^Dip$/ }).waitFor(kLong);
    if (number === 1) await look(person, 'plan-computed');
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
});
