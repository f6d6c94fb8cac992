import { useState } from 'preact/hooks';
import * as rules from '../../api/rules';
import { people as api } from '../../api/services';
import type { Role } from '../../api/types';
import { orComplain } from '../../state/notices';
import { may, who } from '../../state/session';
import { Button, Careful, Choice, TextField } from '../../ui/controls';
import { When } from '../../ui/job_text';
import { List, Once, plainName, useAsked } from './list';
import { kRoles } from './users';

const kDay_s = 86_400;
const kTimes = [
  { value: String(30 * kDay_s), label: '30 days' },
  { value: String(365 * kDay_s), label: 'a year' },
  { value: '', label: 'until it is deleted' },
];

/** Keys that stand for somebody in scripts. */
export function Keys() {
  const { value, failure, again } = useAsked(api.keys);
  const [secret, setSecret] = useState('');
  const keys = value?.apiKeys ?? [];
  return (
    <section aria-labelledby="keys-title">
      <h2 id="keys-title">API keys</h2>
      {secret && (
        <Once title="The key, shown this once: export HYDROPRINT_API_KEY=" secret={secret} />
      )}
      <List
        heads={['Key', 'User', 'Role', 'Last used', 'Ends', '']}
        failure={failure}
        count={value?.apiKeys.length}
        empty="No keys yet. With one, scripts and the program hydroprint may do what you may."
      >
        {keys.map((key) => (
          <tr key={key.name}>
            <th scope="row">{key.displayName || plainName(key.name)}</th>
            <td data-label="User">{plainName(key.user)}</td>
            <td data-label="Role">{key.role?.toLowerCase()}</td>
            <td data-label="Last used">{key.useTime ? <When time={key.useTime} /> : 'never'}</td>
            <td data-label="Ends">{key.expireTime ? <When time={key.expireTime} /> : 'never'}</td>
            <td class="actions">
              <Careful
                kind="plain"
                sure="Delete the key"
                onPress={async () => {
                  orComplain(await api.end(key.name));
                  await again();
                }}
              >
                Delete
              </Careful>
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
    const answer = orComplain(await api.createKey(name, role, Number(time) || undefined));
    if (answer) await made(answer.key);
  };
  return (
    <div class="new">
      <h3>Make a key</h3>
      <div class="row">
        <TextField
          label="What for"
          value={name}
          onValue={setName}
          maxBytes={rules.CreateApiKeyRequest.displayName.maxBytes}
        />
        <Choice
          label="May do"
          value={role}
          choices={kRoles.filter(({ value }) => may(value))}
          onValue={setRole}
        />
        <Choice label="Holds" value={time} choices={kTimes} onValue={setTime} />
        <Button kind="primary" disabled={name === ''} onPress={create}>
          Make
        </Button>
      </div>
    </div>
  );
}
