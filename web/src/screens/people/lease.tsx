import { useState } from 'preact/hooks';
import * as rules from '../../api/rules';
import { breakLease, rig } from '../../state/rig';
import { ConfirmButton, Figures, TextField } from '../../ui/controls';
import { When } from '../../ui/job_text';

/** The holder of the lease, and a button to break it. */
export function Lease() {
  const [reason, setReason] = useState('');
  const lease = rig.value?.lease;
  return (
    <section aria-labelledby="lease-title">
      <h2 id="lease-title">Rig lease</h2>
      {!lease && <p class="quiet">Nobody holds the lease.</p>}
      {lease && (
        <>
          <Figures
            rows={[
              ['Holder', lease.holder],
              ['Purpose', lease.purpose],
              ['Since', <When time={lease.acquireTime} />],
              ['Expires', <When time={lease.expireTime} />],
            ]}
          />
          <TextField
            label="Reason (for the audit log)"
            value={reason}
            onValue={setReason}
            maxBytes={rules.BreakLeaseRequest.reason.maxBytes}
          />
          <ConfirmButton
            kind="danger"
            sure={`Confirm: break the lease of ${lease.holder}`}
            onPress={() => breakLease(reason.trim() || 'no reason given')}
          >
            Break the lease
          </ConfirmButton>
        </>
      )}
    </section>
  );
}
