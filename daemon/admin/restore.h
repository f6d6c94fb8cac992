#pragma once

#include <filesystem>

#include "daemon/admin/backup.h"

namespace hydroprint::admin {

/// Brings a backup back to a state folder, which no daemon may use and which is made if it is not
/// there. All of the archive is unpacked beside what is there and checked, every file by its hash,
/// before anything is replaced; what an archive should not hold (links, other names) is refused. A
/// store of an earlier version is brought to this one. Shows its progress on stderr.
/// @param root      empty: that of this user's daemon
/// @param replaces  whether what is in the folder may go
/// @return kFailedPrecondition: a daemon runs there, or something is in the folder, or
///   STORE_TOO_NEW; kInvalidArgument: it is no whole backup; kResourceExhausted, DISK_FULL. Then
///   the folder is as it was; or, if the power fails at the last step, no daemon starts on it until
///   this was done again (RESTORE_UNFINISHED).
[[nodiscard]] Result<Contents> restore(const std::filesystem::path& root,
                                       const std::filesystem::path& file, bool replaces);

}  // namespace hydroprint::admin
