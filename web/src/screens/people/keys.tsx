import { useState } from 'preact/hooks';
import * as rules from '../../api/rules';
import { people as api } from '../../api/services';
import type { Role } from '../../api/types';
import { orNotify } from '../../state/notices';
import { may, who } from '../../state/session';
import { Button, ConfirmButton, Choice, TextField } from '../../ui/controls';
import { When } from '../../ui/job_text';
import { List, Once, plainName, useFetched } from './list';
import { kRoles } from './users';

const kDay_s = 86_400;
const kTimes = [
  { value: String(30 * kDay_s), label: '30 days' },
  { value: String(365 * kDay_s), label: '1 year' },
  { value: '', label: 'unlimited time' },
];

/** API keys, which let scripts act with their owner's permissions. */
export function Keys() {
  const { value, failure, again } = useFetched(api.keys);
  const [secret, setSecret] = useState('');
  const keys = value?.apiKeys ?? [];
  return (
    <section aria-labelledby="keys-title">
      <h2 id="keys-title">API keys</h2>
      {secret && <Once title="Copy the key now. It will not be shown again:" secret={secret} />}
      <List
        heads={['Key', 'User', 'Role', 'Last used', 'Expires', '']}
        failure={failure}
        count={value?.apiKeys.length}
        empty="No API keys yet. An API key lets scripts act with your permissions."
      >
        {keys.map((key) => (
          <tr key={key.name}>
            <th scope="row">{key.displayName || plainName(key.name)}</th>
            <td data-label="User">{plainName(key.user)}</td>
            <td data-label="Role">{key.role?.toLowerCase()}</td>
            <td data-label="Last used">{key.useTime ? <When time={key.useTime} /> : 'never'}</td>
            <td data-label="Expires">
              {key.expireTime ? <When time={key.expireTime} /> : 'never'}
            </td>
            <td class="actions">
              <ConfirmButton
                kind="plain"
                sure="Confirm deletion"
                onPress={async () => {
                  orNotify(await api.end(key.name));
                  await again();
                }}
              >
                Delete
              </ConfirmButton>
            </td>
          </tr>
        ))}
      </List>
      {!failure && who.value?.accounts && (
        <NewKey
          made={async (key) => {
            setSecret(key);
            await again();
          }}
        />
      )}
    </section>
  );
}

function NewKey({ made }: { made: (key: string) => Promise<void> }) {
  const [name, setName] = useState('');
  const [role, setRole] = useState<Role>(who.value?.role ?? 'VIEWER');
  const [time, setTime] = useState(kTimes[1]!.value);
  const create = async () => {
    const answer = orNotify(await api.createKey(name, role, Number(time) || undefined));
    if (answer) await made(answer.key);
  };
  return (
    <div class="new">
      <h3>New API key</h3>
      <div class="row">
        <TextField
          label="Description"
          value={name}
          onValue={setName}
          maxBytes={rules.CreateApiKeyRequest.displayName.maxBytes}
        />
        <Choice
          label="Role"
          value={role}
          choices={kRoles.filter(({ value }) => may(value))}
          onValue={setRole}
        />
        <Choice label="Valid for" value={time} choices={kTimes} onValue={setTime} />
        <Button kind="primary" disabled={name === ''} onPress={create}>
          Create
        </Button>
      </div>
    </div>
  );
}
