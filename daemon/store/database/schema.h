#pragma once

#include <filesystem>
#include <memory>

#include "daemon/store/database/database.h"

namespace hydroprint::daemon {

/// Opens the store of this build, or creates it if the file does not exist. Opening needs no free
/// disk space. Checks the database first (Database::check()), one of 256 MiB or more only if the
/// last daemon was killed. Also creates the table artifact_bytes, which is only in memory.
/// @return errors of Database::open(), Database::check() and check_build(); kResourceExhausted,
///         DISK_FULL
[[nodiscard]] Result<std::unique_ptr<Database>> open_store(const std::filesystem::path& path);

/// Checks that this build can use a store, if there is one. Reads only the header of the file, so
/// that the file, its log and its folder stay as they are. Call this before locking the folder, and
/// not while this process has the store open: SQLite would lose its locks.
/// @return kFailedPrecondition, STORE_DIFFERS if another build or program made the file
[[nodiscard]] Status check_build(const std::filesystem::path& path);

}  // namespace hydroprint::daemon
