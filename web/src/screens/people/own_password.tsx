import { useState } from 'preact/hooks';
import { people as api } from '../../api/services';
import { orNotify, say } from '../../state/notices';
import { begin, me, who } from '../../state/session';
import { Button, TextField } from '../../ui/controls';

export function OwnPassword() {
  const [before, setBefore] = useState('');
  const [after, setAfter] = useState('');
  const set = async () => {
    if (!orNotify(await api.setPassword(`users/${me.value}`, after, before || undefined))) return;
    setBefore('');
    setAfter('');
    say('Password changed. Your other sessions have ended');
    await begin();
  };
  return (
    <details open={!who.value?.hasPassword}>
      <summary>{who.value?.hasPassword ? 'Change my password' : 'Set my password'}</summary>
      <div class="row">
        {who.value?.hasPassword && (
          <TextField
            label="Old password"
            type="password"
            autocomplete="current-password"
            value={before}
            onValue={setBefore}
          />
        )}
        <TextField
          label="New password (at least 10 characters)"
          type="password"
          autocomplete="new-password"
          value={after}
          onValue={setAfter}
        />
        <Button disabled={after.length < 10} onPress={set}>
          Save password
        </Button>
      </div>
    </details>
  );
}
