import { render } from 'preact';
import { App } from './app';
import { mustSignIn, begin, signIn } from './state/session';
import { complain } from './state/notices';
import './theme';
import './style.css';

/** A one-time link is "sign-in#TOKEN". The token is removed from the address bar immediately. */
async function start(): Promise<void> {
  const token = location.pathname.endsWith('/sign-in') ? location.hash.slice(1) : '';
  if (!location.pathname.endsWith('/')) history.replaceState(null, '', './');
  if (!token) return begin();
  const answer = await signIn({ linkToken: token });
  if (answer.ok) return;
  mustSignIn.value = true;
  complain({
    ...answer.failure,
    remedy:
      'A sign-in link works once, for 15 minutes. Ask for a new link, or sign in with your password',
  });
}

render(<App />, document.getElementById('app')!);
void start();
