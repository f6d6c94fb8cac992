/** The order of the rig's states, which arrive as responses and as events and may overtake each other. */

/** The part of a rig's state that orders it: a decimal string; missing if the daemon does not number its states. */
export interface Revised {
  revision?: string | undefined;
}

// Revisions are below 2^53, so a double holds them exactly.
const revisionOf = (state: Revised | undefined): number => Number(state?.revision ?? 0);

/** True if the state is older than the shown one. States of the same revision are equally new. */
export const isOlder = (state: Revised, shown: Revised | undefined): boolean =>
  revisionOf(state) < revisionOf(shown);
