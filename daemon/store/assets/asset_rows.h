#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "daemon/store/asset.h"
#include "daemon/store/database/database.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::daemon {

/// The asset of any owner, without its owners; kNotFound, ASSET_NOT_FOUND.
[[nodiscard]] Result<Asset> select_asset(Database& database, const std::string& sha256);

/// The error of select_asset().
[[nodiscard]] tl::unexpected<Error> asset_not_found(const std::string& sha256);

/// Stores an asset without an owner; if it exists, its retention starts again.
[[nodiscard]] Status insert_asset(Database& database, const Asset& asset, std::int64_t now_ms);

/// Deletes the row of an asset without an owner that no job uses.
[[nodiscard]] Status delete_unused_asset(Database& database, const std::string& sha256);

/// Whether the asset's file exists with the right size.
[[nodiscard]] bool has_file(const Layout& layout, const Asset& asset);

/// Deletes an asset's file if it has no row, in one transaction, so that nobody can create the same
/// asset meanwhile. The next start deletes a file that remains after a failure.
void discard_unowned_file(Database& database, const Layout& layout, const std::string& sha256);

/// Size of a file; 0 if it does not exist.
[[nodiscard]] std::int64_t size_on_disk(const std::filesystem::path& path);

}  // namespace hydroprint::daemon
