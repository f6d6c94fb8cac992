import { useState } from 'preact/hooks';
import type { Failure } from '../../model/result';
import { signIn } from '../../state/session';
import { TextField } from '../../ui/controls';

export function SignIn() {
  const [user, setUser] = useState('');
  const [password, setPassword] = useState('');
  const [failure, setFailure] = useState<Failure>();
  const [isBusy, setBusy] = useState(false);
  const submit = async (event: Event) => {
    event.preventDefault();
    setBusy(true);
    const answer = await signIn({ user, password });
    setBusy(false);
    setFailure(answer.ok ? undefined : answer.failure);
    if (!answer.ok) setPassword('');
  };
  return (
    <form class="sign-in" onSubmit={(event) => void submit(event)}>
      <h1>Sign in</h1>
      <TextField label="Name" value={user} onValue={setUser} autocomplete="username" />
      <TextField
        label="Password"
        type="password"
        value={password}
        onValue={setPassword}
        autocomplete="current-password"
      />
      {failure && (
        <p class="error" role="alert">
          {failure.what}.
        </p>
      )}
      <button
        type="submit"
        class="primary large"
        disabled={isBusy || user === '' || password === ''}
      >
        Sign in
      </button>
      <p class="quiet">No account or forgotten password? Ask an admin for a sign-in link.</p>
    </form>
  );
}
