import { useState } from 'preact/hooks';
import { may, who } from '../../state/session';
import { Switch } from '../../ui/controls';
import { Audit } from './audit';
import { Keys } from './keys';
import { Lease } from './lease';
import { OwnPassword } from './own_password';
import { Sessions } from './sessions';
import { Users } from './users';

type Tab = 'users' | 'keys' | 'sessions' | 'lease' | 'audit';

/** Admins see everyone's keys and sessions; other users see their own. */
export function People() {
  const isAdmin = may('ADMIN');
  const [tab, setTab] = useState<Tab>(isAdmin ? 'users' : 'keys');
  const tabs: { value: Tab; label: string }[] = [
    ...(isAdmin ? [{ value: 'users' as const, label: 'Users' }] : []),
    { value: 'keys', label: 'API keys' },
    { value: 'sessions', label: 'Sessions' },
    ...(isAdmin
      ? [
          { value: 'lease' as const, label: 'Lease' },
          { value: 'audit' as const, label: 'Audit log' },
        ]
      : []),
  ];
  return (
    <div class="people">
      <h1>People</h1>
      {!who.value?.accounts && (
        <p class="note">
          There are no users yet, so everyone on this machine has full access. Once you add an
          admin, everyone has to sign in.
        </p>
      )}
      <Switch<Tab> label="Show" value={tab} onValue={setTab} choices={tabs} />
      {tab === 'users' && <Users />}
      {tab === 'keys' && <Keys />}
      {tab === 'sessions' && <Sessions />}
      {tab === 'lease' && <Lease />}
      {tab === 'audit' && <Audit />}
      {who.value?.accounts && <OwnPassword />}
    </div>
  );
}
