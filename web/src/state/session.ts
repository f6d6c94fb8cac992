/** The user of this page and their permissions. */
import { computed, signal } from '@preact/signals';
import { csrf } from '../api/call';
import { session as api } from '../api/services';
import type { Role, SignedIn, WhoAmI } from '../api/types';
import { connect, disconnect } from '../events';
import { complain } from './notices';
import type { Result } from '../model/result';

/** Undefined until the daemon has responded. */
export const who = signal<WhoAmI | undefined>(undefined);
/** True once it is known that signing in is required. */
export const mustSignIn = signal(false);

const kRoles: Role[] = ['VIEWER', 'MAKER', 'OPERATOR', 'ADMIN'];

/** True if the user has at least the permissions of the role. */
export const may = (role: Role): boolean =>
  who.value !== undefined && kRoles.indexOf(who.value.role) >= kRoles.indexOf(role);

/** The user's name, as in Job.owner. */
export const me = computed(() => who.value?.user ?? '');

/** True if the user may change jobs of that owner. */
export const mayChange = (owner: string): boolean =>
  may('OPERATOR') || (may('MAKER') && owner === me.value);

/** Fetches the session and then opens the event stream. */
export async function begin(): Promise<void> {
  const answer = await api.who();
  if (answer.ok) {
    csrf.value = answer.value.csrfToken;
    who.value = answer.value;
    mustSignIn.value = false;
    connect();
  } else if (answer.failure.status === 401) {
    end();
  } else {
    // The daemon is not running or is just starting: try again later.
    window.setTimeout(() => void begin(), 1500);
    if (answer.failure.status !== 0) complain(answer.failure);
  }
}

function end(): void {
  disconnect();
  who.value = undefined;
  csrf.value = '';
  mustSignIn.value = true;
}

export async function signIn(
  by: { user: string; password: string } | { linkToken: string },
): Promise<Result<SignedIn>> {
  const answer = await api.signIn(by);
  if (answer.ok) {
    csrf.value = answer.value.csrfToken;
    await begin();
  }
  return answer;
}

export async function signOut(): Promise<void> {
  const answer = await api.signOut();
  if (!answer.ok && answer.failure.status !== 401) return complain(answer.failure);
  end();
}
