#pragma once

#include <filesystem>

#include "sim/base/result.h"

namespace hydroprint::admin {

/// Moves a damaged database to `set-aside/TIME/` in its state folder, which no daemon may be using.
/// The next daemon starts with an empty one, and sets all other files aside.
/// @param root  empty: the folder of this user's daemon
/// @return the new path of the database; kNotFound if there is none; kFailedPrecondition if a
/// daemon
///         is using the folder, or if the database is sound; kPermissionDenied
[[nodiscard]] Result<std::filesystem::path> set_database_aside(const std::filesystem::path& root);

}  // namespace hydroprint::admin
