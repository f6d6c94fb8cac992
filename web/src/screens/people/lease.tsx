import { useState } from 'preact/hooks';
import * as rules from '../../api/rules';
import { breakLease, rig } from '../../state/rig';
import { Careful, Figures, TextField } from '../../ui/controls';
import { When } from '../../ui/job_text';

/** Who has the rig, and how to take it away. */
export function Lease() {
  const [reason, setReason] = useState('');
  const lease = rig.value?.lease;
  return (
    <section aria-labelledby="lease-title">
      <h2 id="lease-title">Lease of the rig</h2>
      {!lease && <p class="quiet">Nobody has the rig.</p>}
      {lease && (
        <>
          <Figures
            rows={[
              ['Holder', lease.holder],
              ['For', lease.purpose],
              ['Since', <When time={lease.acquireTime} />],
              ['Ends', <When time={lease.expireTime} />],
            ]}
          />
          <TextField
            label="Why it is taken away; it is logged"
            value={reason}
            onValue={setReason}
            maxBytes={rules.BreakLeaseRequest.reason.maxBytes}
          />
          <Careful
            kind="danger"
            sure={`Take it away from ${lease.holder}`}
            onPress={() => breakLease(reason.trim() || 'no reason given')}
          >
            Break the lease
          </Careful>
        </>
      )}
    </section>
  );
}
