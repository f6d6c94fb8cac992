#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::daemon {

/// Returns the name of a user of this machine, or the id of one without a name.
[[nodiscard]] std::string user_name(uid_t id);

/// Returns kPermissionDenied if a file or folder belongs to another user than this process.
[[nodiscard]] Status check_is_mine(const std::filesystem::path& path);

/// Sets the mode of a file or folder of this user, for example to 0700.
/// @return the mode before, if it was changed; kFailedPrecondition if other users still have rights
///         afterwards, because the file system does not keep modes
[[nodiscard]] Result<std::optional<mode_t>> set_mode(const std::filesystem::path& path,
                                                     mode_t mode);

/// Returns kFailedPrecondition if other users have rights on a file or folder that should have this
/// mode.
[[nodiscard]] Status check_mode(const std::filesystem::path& path, mode_t mode);

}  // namespace hydroprint::daemon
