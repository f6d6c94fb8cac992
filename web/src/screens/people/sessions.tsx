import { people as api } from '../../api/services';
import { orNotify } from '../../state/notices';
import { Button } from '../../ui/controls';
import { When } from '../../ui/job_text';
import { List, plainName, useFetched } from './list';

/** All open sessions. */
export function Sessions() {
  const { value, failure, again } = useFetched(api.sessions);
  const sessions = value?.sessions ?? [];
  return (
    <section aria-labelledby="sessions-title">
      <h2 id="sessions-title">Sessions</h2>
      <List
        heads={['User', 'Address', 'Started', 'Last used', 'Expires', '']}
        failure={failure}
        count={value?.sessions.length}
        empty="Nobody is signed in."
      >
        {sessions.map((session) => (
          <tr key={session.name}>
            <th scope="row">
              {plainName(session.user)}
              {session.current && <span class="quiet">this session</span>}
            </th>
            <td data-label="Address">{session.peer}</td>
            <td data-label="Started">
              <When time={session.createTime} />
            </td>
            <td data-label="Last used">
              <When time={session.useTime} />
            </td>
            <td data-label="Expires">
              <When time={session.expireTime} />
            </td>
            <td class="actions">
              {!session.current && (
                <Button
                  kind="plain"
                  onPress={async () => {
                    orNotify(await api.end(session.name));
                    await again();
                  }}
                >
                  End
                </Button>
              )}
            </td>
          </tr>
        ))}
      </List>
    </section>
  );
}
