#pragma once

#include "daemon/platform/durable_file.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::daemon {

/// Locks the state folder (created if needed) for this process, until the descriptor is closed.
/// @return kFailedPrecondition if another daemon uses the folder
[[nodiscard]] Result<UniqueFd> lock_state(const Layout& layout);

/// Returns kFailedPrecondition, RESTORE_UNFINISHED for a folder with an unfinished restore.
[[nodiscard]] Status check_restored(const Layout& layout);

}  // namespace hydroprint::daemon
