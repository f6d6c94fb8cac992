#pragma once

#include "daemon/platform/durable_file.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::daemon {

/// Takes the state folder (made if it is not there) for this process, until the descriptor is
/// closed.
/// @return kFailedPrecondition if another daemon has it
[[nodiscard]] Result<UniqueFd> lock_state(const Layout& layout);

/// Refuses (kFailedPrecondition, RESTORE_UNFINISHED) a folder to which a backup was being restored.
[[nodiscard]] Status check_restored(const Layout& layout);

}  // namespace hydroprint::daemon
