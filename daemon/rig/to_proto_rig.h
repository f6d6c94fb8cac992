#pragma once

#include "daemon/rig/rig_gateway.h"
#include "hydroprint/v1/rig.pb.h"

namespace hydroprint::daemon {

/// Returns the rig as an API message, also if the drive does not respond or none is configured.
/// A message of a greater revision never describes an older state, also after a restart of the
/// daemon. Waits only for other threads that create such a message.
[[nodiscard]] v1::Rig rig_message(const RigGateway& gateway);

/// Returns whether two messages are equal except for the revision, the time of the last poll and
/// the link quality.
[[nodiscard]] bool looks_same(v1::Rig a, v1::Rig b);

/// Converts a lease to its API message. Only the holder of the lease sees its id.
[[nodiscard]] v1::Lease to_message(const Lease& lease, bool with_id);

}  // namespace hydroprint::daemon
