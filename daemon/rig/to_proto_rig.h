#pragma once

#include "daemon/rig/rig_gateway.h"
#include "hydroprint/v1/rig.pb.h"

namespace hydroprint::daemon {

/// The rig as the API shows it now, whether or not a drive answers or is configured. Waits for
/// nothing.
[[nodiscard]] v1::Rig rig_message(const RigGateway& gateway);

/// True if a watcher would see the same; that the drive was looked at is no change.
[[nodiscard]] bool looks_same(v1::Rig a, v1::Rig b);

/// A lease as everyone may see it; its holder sees the id as well.
[[nodiscard]] v1::Lease to_message(const Lease& lease, bool with_id);

}  // namespace hydroprint::daemon
