/** Accounts of every role, so that each test runs as a suitable user. */
import type { Browser, Page } from 'playwright-core';
import { visit, type Person } from './browser';

export const kPassword = 'correct horse battery';

const kPeople = { otto: 'OPERATOR', mia: 'MAKER', max: 'MAKER', vera: 'VIEWER' } as const;
export type Name = keyof typeof kPeople | 'root';

/** Creates the admin `root` and, signed in as root, the other users. All have the same password. */
export async function addPeople(address: string): Promise<void> {
  const send = async (path: string, json: unknown, headers = {}) => {
    const response = await fetch(`${address}/v1/${path}`, {
      method: 'POST',
      headers: { 'Content-Type': 'application/json', ...headers },
      body: JSON.stringify(json),
    });
    if (!response.ok) throw new Error(`${path}: ${await response.text()}`);
    return response;
  };
  const add = (name: Name, role: string, headers = {}) =>
    send('users', { user: { name: `users/${name}`, role }, password: kPassword }, headers);
  await add('root', 'ADMIN');
  const session = await send('session:signIn', { user: 'root', password: kPassword });
  const { csrfToken } = (await session.json()) as { csrfToken: string };
  // The daemon sets one cookie. getSetCookie(), which handles several, is missing in Debian 12's Node.
  const Cookie = session.headers.get('Set-Cookie')!.split(';')[0]!;
  for (const [name, role] of Object.entries(kPeople))
    await add(name as Name, role, { Cookie, 'X-Hydroprint-Csrf': csrfToken });
}

/** Signs in on the open page. */
export async function signIn(page: Page, name: Name): Promise<void> {
  await page.getByLabel('Name').fill(name);
  await page.getByLabel('Password').fill(kPassword);
  await page.locator('form').getByRole('button', { name: 'Sign in' }).click();
  await page.getByRole('button', { name: 'Sign out' }).waitFor();
}

export interface Place {
  browser: Browser;
  address: string;
}

/** Opens a screen as a signed-in user. */
export async function come(
  { browser, address }: Place,
  name: Name,
  path = '',
  width = 1280,
): Promise<Person> {
  const person = await visit(browser, `${address}/#/${path}`, width);
  await signIn(person.page, name);
  return person;
}
