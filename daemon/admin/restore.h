#pragma once

#include <filesystem>

#include "daemon/admin/backup.h"

namespace hydroprint::admin {

/// Restores a backup to a state folder, which no daemon may be using; creates the folder if it does
/// not exist. Unpacks the whole archive next to the current state and checks every file's hash
/// before it replaces anything. Unexpected entries (links, other names) are errors. Shows its
/// progress on stderr.
/// After an error the folder is unchanged. If the power fails during the last step, no daemon
/// starts on the folder until the restore is repeated (RESTORE_UNFINISHED).
/// @param root      empty: the folder of this user's daemon
/// @param replaces  whether the content of the folder may be deleted
/// @return kFailedPrecondition if a daemon is using the folder, or if the folder is not empty;
///         kFailedPrecondition, STORE_DIFFERS if another build made the backup; kInvalidArgument
///         if the backup is not complete; kResourceExhausted, DISK_FULL
[[nodiscard]] Result<Contents> restore(const std::filesystem::path& root,
                                       const std::filesystem::path& file, bool replaces);

}  // namespace hydroprint::admin
