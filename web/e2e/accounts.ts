/** Accounts of every role, so that each test runs as a suitable user, and requests of the admin. */
import type { Page } from 'playwright-core';
import { visit, type Person } from './browser';
import type { Place } from './place';

export const kPassword = 'correct horse battery';

const kPeople = { otto: 'OPERATOR', mia: 'MAKER', max: 'MAKER', vera: 'VIEWER' } as const;
export type Name = keyof typeof kPeople | 'root';

/** Sends a request to the daemon and returns its response; throws if the daemon refuses. */
export type Send = <T>(method: 'GET' | 'POST', path: string, json?: unknown) => Promise<T>;

const kPatience_ms = 20_000;

async function ask(address: string, method: string, path: string, json: unknown, headers = {}) {
  const response = await fetch(`${address}/v1/${path}`, {
    method,
    headers: { 'Content-Type': 'application/json', ...headers },
    body: method === 'GET' ? null : JSON.stringify(json ?? {}),
    signal: AbortSignal.timeout(kPatience_ms),
  });
  if (!response.ok) throw new Error(`${method} ${path}: ${await response.text()}`);
  return response;
}

/** Sends requests as the admin `root`, or without credentials if there are no accounts yet. */
export async function asAdmin(address: string): Promise<Send> {
  const headers: Record<string, string> = {};
  const send: Send = async (method, path, json) => {
    const text = await (await ask(address, method, path, json, headers)).text();
    return text === '' ? {} : JSON.parse(text);
  };
  const isOpen = await send('GET', 'session').then(
    () => true,
    () => false,
  );
  if (isOpen) return send;
  const session = await ask(address, 'POST', 'session:signIn', {
    user: 'root',
    password: kPassword,
  });
  const { csrfToken } = (await session.json()) as { csrfToken: string };
  // The daemon sets one cookie. getSetCookie(), which handles several, is missing in Debian 12's Node.
  headers['Cookie'] = session.headers.get('Set-Cookie')!.split(';')[0]!;
  headers['X-Hydroprint-Csrf'] = csrfToken;
  return send;
}

/** Creates the admin `root` and, signed in as root, the other users. All have the same password. */
export async function addPeople(address: string): Promise<void> {
  const add = (send: Send, name: Name, role: string) =>
    send('POST', 'users', { user: { name: `users/${name}`, role }, password: kPassword });
  await add(await asAdmin(address), 'root', 'ADMIN');
  const send = await asAdmin(address);
  for (const [name, role] of Object.entries(kPeople)) await add(send, name as Name, role);
}

/** Signs in on the open page. */
export async function signIn(page: Page, name: Name): Promise<void> {
  await page.getByLabel('Name').fill(name);
  await page.getByLabel('Password').fill(kPassword);
  await page.locator('form').getByRole('button', { name: 'Sign in' }).click();
  await page.getByRole('button', { name: 'Sign out' }).waitFor();
}

/** Opens a screen as a signed-in user. */
export async function come(
  { browser, daemon }: Place,
  name: Name,
  path = '',
  width = 1280,
): Promise<Person> {
  const person = await visit(browser, `${daemon.address}/#/${path}`, width);
  await signIn(person.page, name);
  return person;
}
