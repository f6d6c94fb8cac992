/** Accounts, from the first admin on: who may do what, and a viewer who may stop and nothing else. */
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, expect, test } from 'vitest';
import { isAccessible, launch, open, picture, visit } from './browser';
import { Daemon } from './daemon';

const kPassword = 'correct horse battery';

let daemon: Daemon;
let browser: Browser;
let hasPeople = false;
beforeAll(async () => {
  [daemon, browser] = await Promise.all([Daemon.start(), launch()]);
  hasPeople = (await fetch(`${daemon.address}/v1/session`)).ok;
});
afterAll(async () => {
  await browser?.close();
  await daemon?.stop();
});

const press = (page: Page, name: string | RegExp) =>
  page.getByRole('button', { name, exact: typeof name === 'string' }).click();

async function signIn(page: Page, name: string): Promise<void> {
  await page.getByLabel('Name').fill(name);
  await page.getByLabel('Password').fill(kPassword);
  await page.locator('form').getByRole('button', { name: 'Sign in' }).click();
  await page.getByRole('button', { name: 'Sign out' }).waitFor();
}

/** What the daemon says to a request of this page's, with all that the page itself would send. */
const ask = (page: Page, method: string, path: string, body: unknown): Promise<number> =>
  page.evaluate(
    async ([how, where, json]) => {
      const { csrfToken } = (await (await fetch('/v1/session')).json()) as { csrfToken: string };
      const headers = { 'Content-Type': 'application/json', 'X-Hydroprint-Csrf': csrfToken };
      return (await fetch(where, { method: how, headers, body: json })).status;
    },
    [method, path, JSON.stringify(body)] as const,
  );

test('people from the first admin to a viewer, who may stop and nothing else', async (context) => {
  if (!hasPeople) return context.skip();
  const admin = await visit(browser, `${daemon.address}/#/people`);
  const { page } = admin;
  await page.getByText('There are no users yet').waitFor();
  await picture(admin, 'people-first');
  await page.getByLabel('Name').fill('root');
  await page.getByLabel(/^Password/).fill(kPassword);
  await press(page, 'Add');
  await page.getByRole('heading', { name: 'Sign in' }).waitFor();
  await picture(admin, 'sign-in');
  await isAccessible(admin, 'sign-in');
  await page.getByLabel('Name').fill('root');
  await page.getByLabel('Password').fill('something wrong');
  await page.locator('form').getByRole('button', { name: 'Sign in' }).click();
  await page.getByRole('alert').waitFor();
  await signIn(page, 'root');

  await open(admin, '/people');
  await page.getByRole('heading', { name: 'Add a user' }).waitFor();
  await page.getByLabel('Name').fill('vera');
  await page.getByLabel('Role', { exact: true }).selectOption('VIEWER');
  await page.getByLabel(/^Password/).fill(kPassword);
  await press(page, 'Add');
  await page.getByLabel('Role of vera').waitFor();
  await page.getByLabel('Name').fill('mia');
  await page.getByLabel('Role', { exact: true }).selectOption('MAKER');
  await press(page, 'Add');
  await page
    .getByRole('row', { name: /mia/ })
    .getByRole('button', { name: 'Sign-in link' })
    .click();
  const address = await page.locator('.once code').innerText();
  await picture(admin, 'people-users');
  await isAccessible(admin, 'people, users');

  const maker = await visit(browser, address);
  await maker.page.getByText('mia', { exact: true }).waitFor();
  expect(maker.page.url()).not.toContain(address.split('#')[1]!);
  const again = await visit(browser, address);
  await again.page.getByRole('heading', { name: 'Sign in' }).waitFor();
  await again.page.getByText('A link works once').waitFor();

  const viewer = await visit(browser, daemon.address, 390);
  await signIn(viewer.page, 'vera');
  await viewer.page.getByText('You may look, but not submit').waitFor();
  await open(viewer, '/rig');
  await viewer.page.getByText('You may look, and stop').waitFor();
  expect(await viewer.page.getByRole('button', { name: 'Take the rig' }).count()).toBe(0);
  await picture(viewer, 'rig-viewer');
  await press(viewer.page, 'Stop');
  await viewer.page.getByRole('button', { name: 'Stopped' }).waitFor();
  const refused: [string, string, unknown][] = [
    ['POST', '/v1/jobs', { validate: { quick: true } }],
    ['POST', '/v1/rig/lease:acquire', { purpose: 'mischief' }],
    ['POST', '/v1/queue:pause', {}],
    ['POST', '/v1/users', { user: { name: 'users/eve', role: 'ADMIN' } }],
  ];
  for (const [method, path, body] of refused)
    expect(await ask(viewer.page, method, path, body), path).toBe(403);
  expect(await ask(viewer.page, 'POST', '/v1/rig:stop', {})).toBe(200);

  for (const tab of ['Keys', 'Sessions', 'Lease', 'Audit']) {
    await page.getByRole('radio', { name: tab }).check();
    await page.waitForTimeout(500);
    await picture(admin, `people-${tab.toLowerCase()}`);
    await isAccessible(admin, `people, ${tab.toLowerCase()}`);
  }
  await page.getByText('LeaseService.AcquireLease').first().waitFor();
  await press(page, 'Sign out');
  await page.getByRole('heading', { name: 'Sign in' }).waitFor();
  const complaints = [admin, maker, again, viewer].flatMap((person) => person.complaints);
  expect(complaints).toEqual([]);
});
