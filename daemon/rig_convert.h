#pragma once

#include "daemon/rig_desk.h"
#include "hydroprint/v1/rig.pb.h"

namespace hydroprint::daemon {

/// The rig as the API shows it now, whether or not a drive answers or is configured. Waits for
/// nothing.
[[nodiscard]] v1::Rig rig_message(const RigDesk& desk);

/// A lease as everyone may see it; its holder sees the id as well.
[[nodiscard]] v1::Lease to_message(const Lease& lease, bool with_id);

}  // namespace hydroprint::daemon
