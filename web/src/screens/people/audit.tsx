import { useEffect, useState } from 'preact/hooks';
import { people as api } from '../../api/services';
import type { AuditEntry } from '../../api/types';
import type { Failure } from '../../model/result';
import { Button, Choice, TextField } from '../../ui/controls';
import { When } from '../../ui/job_text';
import { List } from './list';

const kWhat = [
  { value: '', label: 'Everything' },
  { value: 'RigService.', label: 'Rig' },
  { value: 'LeaseService.', label: 'Lease' },
  { value: 'JobService.', label: 'Jobs' },
  { value: 'PeopleService.', label: 'People' },
];

/** The audit log, newest entry first. */
export function Audit() {
  const [entries, setEntries] = useState<AuditEntry[]>();
  const [next, setNext] = useState('');
  const [failure, setFailure] = useState<Failure>();
  const [name, setName] = useState('');
  const [what, setWhat] = useState('');
  const ask = async (pageToken: string, before: AuditEntry[]) => {
    const answer = await api.audit({ who: name, what, pageToken });
    setFailure(answer.ok ? undefined : answer.failure);
    if (!answer.ok) return;
    setEntries([...before, ...answer.value.entries]);
    setNext(answer.value.nextPageToken);
  };
  useEffect(() => {
    const timer = window.setTimeout(() => void ask('', []), 200);
    return () => window.clearTimeout(timer);
  }, [name, what]);
  return (
    <section aria-labelledby="audit-title">
      <h2 id="audit-title">Audit log</h2>
      <div class="row">
        <TextField label="User" value={name} onValue={setName} />
        <Choice label="Action" value={what} choices={kWhat} onValue={setWhat} />
      </div>
      <List
        heads={['Time', 'User', 'Action', 'Outcome']}
        failure={failure}
        count={entries?.length}
        empty="No matching entries."
      >
        {(entries ?? []).map((entry) => (
          <tr key={entry.seq}>
            <td>
              <When time={entry.time} />
            </td>
            <th scope="row">
              {entry.who || 'unknown'}
              <span class="quiet">
                {entry.via} {entry.peer}
              </span>
            </th>
            <td>
              {entry.what} {entry.object}
            </td>
            <td>
              {entry.outcome} <span class="quiet">{entry.detail}</span>
            </td>
          </tr>
        ))}
      </List>
      {next && <Button onPress={() => ask(next, entries ?? [])}>Older</Button>}
    </section>
  );
}
