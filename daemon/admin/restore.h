#pragma once

#include <filesystem>

#include "daemon/admin/backup.h"

namespace hydroprint::admin {

/// Restores a backup to a state folder. No daemon may use the folder; it is created if it does not
/// exist. The whole archive is unpacked next to the present state and every file's hash is checked
/// before anything is replaced. Unexpected entries (links, other names) are refused. A store of an
/// earlier version is migrated. Shows its progress on stderr.
/// @param root      empty: the folder of this user's daemon
/// @param replaces  whether the content of the folder may be deleted
/// @return kFailedPrecondition if a daemon runs there, the folder is not empty, or STORE_TOO_NEW;
/// kInvalidArgument if the backup is not complete; kResourceExhausted, DISK_FULL. After an error
/// the folder is unchanged. If the power fails in the last step, no daemon starts on it until the
/// restore is repeated (RESTORE_UNFINISHED).
[[nodiscard]] Result<Contents> restore(const std::filesystem::path& root,
                                       const std::filesystem::path& file, bool replaces);

}  // namespace hydroprint::admin
