import { useState } from 'preact/hooks';
import { people as api } from '../../api/services';
import type { Role, User } from '../../api/types';
import { orNotify, say } from '../../state/notices';
import { begin, may, me } from '../../state/session';
import { Button, ConfirmButton, Choice, TextField } from '../../ui/controls';
import { When } from '../../ui/job_text';
import { List, Once, plainName, useFetched } from './list';

export const kRoles: readonly { value: Role; label: string }[] = [
  { value: 'VIEWER', label: 'Viewer: can view jobs and the rig, and stop the rig' },
  { value: 'MAKER', label: 'Maker: can also submit jobs' },
  { value: 'OPERATOR', label: 'Operator: can also control the rig and the queue' },
  { value: 'ADMIN', label: 'Admin: can also manage users' },
];

export function Users() {
  const { value, failure, again } = useFetched(api.users);
  const [link, setLink] = useState<{ user: string; address: string }>();
  const users = value?.users ?? [];
  const makeLink = async (user: User) => {
    const made = orNotify(await api.link(user.name));
    if (made)
      setLink({
        user: plainName(user.name),
        address: new URL(`sign-in#${made.token}`, location.href).href,
      });
  };
  return (
    <section aria-labelledby="users-title">
      <h2 id="users-title">Users</h2>
      {link && (
        <Once
          title={`Sign-in link for ${link.user} (works once, for 15 minutes):`}
          secret={link.address}
        />
      )}
      <List
        heads={['Name', 'Role', 'Created', '']}
        failure={failure}
        count={value?.users.length}
        empty="No users yet."
      >
        {users.map((user) => (
          <Row key={user.name} user={user} again={again} makeLink={() => makeLink(user)} />
        ))}
      </List>
      {value && !failure && <NewUser isFirst={users.length === 0} again={again} />}
    </section>
  );
}

function Row(props: { user: User; again: () => Promise<void>; makeLink: () => Promise<void> }) {
  const { user, again } = props;
  const change = async (what: { role?: Role; disabled?: boolean }) => {
    orNotify(await api.update(user.name, what));
    await again();
  };
  return (
    <tr>
      <th scope="row">
        {plainName(user.name)}
        {plainName(user.name) === me.value && <span class="quiet">you</span>}
        {user.disabled && <span class="quiet">disabled</span>}
        {!user.hasPassword && <span class="quiet">no password yet</span>}
      </th>
      <td>
        <Choice
          label={`Role of ${plainName(user.name)}`}
          value={user.role}
          choices={kRoles}
          onValue={(role) => void change({ role })}
        />
      </td>
      <td>
        <When time={user.createTime} />
      </td>
      <td class="actions">
        <Button kind="plain" onPress={props.makeLink}>
          Sign-in link
        </Button>
        <Button kind="plain" onPress={() => change({ disabled: !user.disabled })}>
          {user.disabled ? 'Enable' : 'Disable'}
        </Button>
        <ConfirmButton
          kind="plain"
          sure={`Delete ${plainName(user.name)}`}
          onPress={async () => {
            orNotify(await api.remove(user.name));
            await again();
          }}
        >
          Delete
        </ConfirmButton>
      </td>
    </tr>
  );
}

function NewUser({ isFirst, again }: { isFirst: boolean; again: () => Promise<void> }) {
  const [name, setName] = useState('');
  const [password, setPassword] = useState('');
  const [role, setRole] = useState<Role>('MAKER');
  const create = async () => {
    const made = orNotify(
      await api.create({ name: `users/${name}`, role: isFirst ? 'ADMIN' : role }, password),
    );
    if (!made) return;
    say(`${name} was added`);
    setName('');
    setPassword('');
    // Once there is a user, signing in is required.
    if (isFirst) await begin();
    if (may('ADMIN')) await again();
  };
  return (
    <div class="new">
      <h3>{isFirst ? 'Add the first admin' : 'Add a user'}</h3>
      <div class="row">
        <TextField label="Name" value={name} onValue={setName} maxBytes={64} />
        {!isFirst && <Choice label="Role" value={role} choices={kRoles} onValue={setRole} />}
        <TextField
          label={
            isFirst
              ? 'Password (at least 10 characters)'
              : 'Password (at least 10 characters, or none: then create a sign-in link)'
          }
          type="password"
          autocomplete="new-password"
          value={password}
          onValue={setPassword}
        />
        <Button
          kind="primary"
          disabled={name === '' || (isFirst && password.length < 10)}
          onPress={create}
        >
          Add
        </Button>
      </div>
    </div>
  );
}
