/** Accounts and permissions: the first admin, other users, and a viewer who can only stop the rig. */
import type { Page } from 'playwright-core';
import { expect, test } from 'vitest';
import { kPassword, signIn } from './accounts';
import { open, visit } from './browser';
import { look } from './checks';
import { rareTest, usePlace } from './place';

const there = usePlace();

const press = (page: Page, name: string | RegExp) =>
  page.getByRole('button', { name, exact: typeof name === 'string' }).click();

/** Sends a request from the page with the page's credentials; returns the HTTP status. */
const ask = (page: Page, method: string, path: string, body: unknown): Promise<number> =>
  page.evaluate(
    async ([how, where, json]) => {
      const { csrfToken } = (await (await fetch('/v1/session')).json()) as { csrfToken: string };
      const headers = {
        'Content-Type': how === 'PATCH' ? 'application/offset+octet-stream' : 'application/json',
        'Upload-Offset': '0',
        'X-Hydroprint-Csrf': csrfToken,
      };
      return (await fetch(where, { method: how, headers, body: json })).status;
    },
    [method, path, JSON.stringify(body)] as const,
  );

const kHeads = {
  Keys: 'API keys',
  Sessions: 'Sessions',
  Lease: 'Rig lease',
  Audit: 'Audit log',
} as const;

// Allowed for every role: stop, sign in and out, and manage one's own keys, sessions and password.
const kOwn = [
  'POST /v1/rig:stop',
  'POST /v1/session:signIn',
  'POST /v1/session:signOut',
  'POST /v1/apiKeys',
  'DELETE /v1/apiKeys/1',
  'DELETE /v1/sessions/1',
  'POST /v1/users/1:setPassword',
];

/** All routes in the daemon's OpenAPI document that change something, except those in kOwn. */
const changingRoutes = (page: Page): Promise<[string, string][]> =>
  page.evaluate(async (own) => {
    const { paths } = (await (await fetch('/openapi.json')).json()) as {
      paths: Record<string, Record<string, unknown>>;
    };
    return Object.entries(paths)
      .flatMap(([path, methods]) =>
        Object.keys(methods).map((method): [string, string] => [
          method.toUpperCase(),
          path.replace(/\{[^}]+\}/g, '1'),
        ]),
      )
      .filter(
        ([method, path]) =>
          ['POST', 'PUT', 'PATCH', 'DELETE'].includes(method) && !own.includes(`${method} ${path}`),
      );
  }, kOwn);

test('the first screen is small and shows the first step', async () => {
  const person = await visit(there.browser, 'about:blank');
  const sizes: number[] = [];
  person.page.on('requestfinished', (request) => {
    request.sizes().then(
      ({ responseBodySize }) => sizes.push(responseBodySize),
      () => {}, // the event stream, which ends with the page
    );
  });
  const begun = Date.now();
  await person.page.goto(there.daemon.address);
  await person.page.getByRole('button', { name: 'Choose files' }).waitFor();
  const took_ms = Date.now() - begun;
  await person.page.waitForLoadState('load');
  const total = sizes.reduce((sum, size) => sum + size, 0);
  expect(total).toBeLessThan(80_000);
  expect(total).toBeGreaterThan(1000);
  console.log(`first screen: ${Math.round(total / 1000)} kB, ${took_ms} ms`);
  expect(person.complaints).toEqual([]);
});

rareTest('every control can be reached by keyboard, with a visible focus', async () => {
  const person = await visit(there.browser, there.daemon.address);
  const { page } = person;
  await page.getByRole('button', { name: 'Mug' }).waitFor();
  // The focused element, and whether the focus is visible.
  const focused = () =>
    page.evaluate(() => {
      const element = document.activeElement as HTMLElement;
      const seen = element.matches('.switch input') ? element.nextElementSibling! : element;
      const { outlineStyle, outlineWidth } = getComputedStyle(seen);
      const name = element.getAttribute('aria-label') ?? element.innerText ?? '';
      const label = (element as HTMLInputElement).labels?.[0]?.innerText;
      return {
        name: (label ?? name).trim().split('\n')[0],
        // After the last control, the focus leaves the page.
        isSeen:
          element === document.body || (outlineStyle !== 'none' && parseFloat(outlineWidth) >= 2),
      };
    });
  const tabTo = async (name: string) => {
    for (let i = 0; i < 40; i += 1) {
      await page.keyboard.press('Tab');
      const at = await focused();
      expect(at.isSeen, `the focus on "${at.name}"`).toBe(true);
      if (at.name === name) return;
    }
    throw new Error(`"${name}" is not reached with Tab`);
  };

  await page.keyboard.press('Tab');
  expect((await focused()).name).toBe('Skip to content');
  await page.keyboard.press('Enter');
  expect(await page.evaluate(() => document.activeElement?.id)).toBe('main');
  await tabTo('Choose files');
  await tabTo('Mug');
  await page.keyboard.press('Enter');
  await page.locator('.stage canvas').waitFor();
  await page.locator('#main').focus();
  await tabTo('Longest side');
  await page.keyboard.press('ControlOrMeta+a');
  await page.keyboard.type('80');
  await tabTo('Rotation about x');
  await page.keyboard.press('ArrowUp');
  expect(await page.getByLabel('Rotation about x').inputValue()).toBe('1');
  await tabTo('More settings');
  await page.keyboard.press('Enter');
  await page.getByLabel('Dip speed').waitFor();
  await tabTo('Simulate');
  await tabTo('Start over');
  await page.keyboard.press('Enter');
  await page.getByRole('button', { name: 'Choose files' }).waitFor();

  // A button that asks for confirmation keeps the focus, and Escape cancels.
  await open(person, '/rig');
  await page.getByLabel('Purpose').focus();
  await tabTo('Take control');
  await page.keyboard.press('Enter');
  await page.getByRole('button', { name: 'Arm' }).waitFor();
  await tabTo('Arm');
  await page.keyboard.press('Enter');
  const disarm = page.getByRole('button', { name: 'Disarm' });
  await disarm.waitFor({ timeout: 30_000 });
  await page.locator('#main').focus();
  await tabTo('Disarm');
  await page.keyboard.press('Enter');
  expect((await focused()).name).toBe('Confirm disarm; the axis may sink');
  await page.keyboard.press('Escape');
  expect((await focused()).name).toBe('Disarm');
  await page.keyboard.press('Enter');
  await page.keyboard.press('Enter');
  await page.locator('.big', { hasText: 'Disarmed' }).waitFor({ timeout: 30_000 });
  await page.getByRole('button', { name: 'Release the rig' }).click();
  expect(person.complaints).toEqual([]);
});

test('the first admin adds users; a viewer can stop the rig and change nothing else', async () => {
  const admin = await visit(there.browser, `${there.daemon.address}/#/people`);
  const { page } = admin;
  await page.getByText('There are no users yet').waitFor();
  await look(admin, 'people-first');
  await page.getByLabel('Name').fill('root');
  await page.getByLabel(/^Password/).fill(kPassword);
  await press(page, 'Add');
  await page.getByRole('heading', { name: 'Sign in' }).waitFor();
  await look(admin, 'sign-in');
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
  await look(admin, 'people-users');

  const maker = await visit(there.browser, address);
  await maker.page.getByText('mia', { exact: true }).waitFor();
  expect(maker.page.url()).not.toContain(address.split('#')[1]!);
  const again = await visit(there.browser, address);
  await again.page.getByRole('heading', { name: 'Sign in' }).waitFor();
  await again.page.getByText('A sign-in link works once').waitFor();

  const viewer = await visit(there.browser, there.daemon.address, 390);
  await signIn(viewer.page, 'vera');
  await viewer.page.getByText('You can view this page but not submit jobs').waitFor();
  await open(viewer, '/rig');
  await viewer.page.getByText('You can view the rig and stop it').waitFor();
  expect(await viewer.page.getByRole('button', { name: 'Take control' }).count()).toBe(0);
  await look(viewer, 'rig-viewer');
  await press(viewer.page, 'Stop');
  await viewer.page.getByRole('button', { name: 'Stopped' }).waitFor();
  const changes = await changingRoutes(viewer.page);
  expect(changes.length).toBeGreaterThanOrEqual(30);
  for (const [method, path] of changes)
    expect(await ask(viewer.page, method, path, {}), `${method} ${path}`).toBe(403);
  expect(await ask(viewer.page, 'POST', '/v1/rig:stop', {})).toBe(200);

  for (const tab of ['Keys', 'Sessions', 'Lease', 'Audit'] as const) {
    await page.getByRole('radio', { name: tab }).check();
    await page.getByRole('heading', { name: kHeads[tab], exact: true }).waitFor();
    await look(admin, `people-${tab.toLowerCase()}`);
  }
  await page.getByText('LeaseService.AcquireLease').first().waitFor();
  await press(page, 'Sign out');
  await page.getByRole('heading', { name: 'Sign in' }).waitFor();
  const complaints = [admin, maker, again, viewer].flatMap((person) => person.complaints);
  expect(complaints).toEqual([]);
});
