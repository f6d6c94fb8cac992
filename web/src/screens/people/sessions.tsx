import { people as api } from '../../api/services';
import { orComplain } from '../../state/notices';
import { Button } from '../../ui/controls';
import { When } from '../../ui/job_text';
import { List, plainName, useAsked } from './list';

/** Who is signed in, where. */
export function Sessions() {
  const { value, failure, again } = useAsked(api.sessions);
  const sessions = value?.sessions ?? [];
  return (
    <section aria-labelledby="sessions-title">
      <h2 id="sessions-title">Sessions</h2>
      <List
        heads={['User', 'From', 'Begun', 'Last used', 'Ends', '']}
        failure={failure}
        count={value?.sessions.length}
        empty="Nobody is signed in."
      >
        {sessions.map((session) => (
          <tr key={session.name}>
            <th scope="row">
              {plainName(session.user)}
              {session.current && <span class="quiet">this one</span>}
            </th>
            <td data-label="From">{session.peer}</td>
            <td data-label="Begun">
              <When time={session.createTime} />
            </td>
            <td data-label="Last used">
              <When time={session.useTime} />
            </td>
            <td data-label="Ends">
              <When time={session.expireTime} />
            </td>
            <td class="actions">
              {!session.current && (
                <Button
                  kind="plain"
                  onPress={async () => {
                    orComplain(await api.end(session.name));
                    await again();
                  }}
                >
                  End it
                </Button>
              )}
            </td>
          </tr>
        ))}
      </List>
    </section>
  );
}
