#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "daemon/store/asset.h"
#include "daemon/store/database/database.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::daemon {

/// Returns an asset, whether or not it has owners; Asset::owners remains empty. Errors: kNotFound,
/// ASSET_NOT_FOUND.
[[nodiscard]] Result<Asset> select_asset(Database& database, const std::string& sha256);

/// Returns the error ASSET_NOT_FOUND.
[[nodiscard]] tl::unexpected<Error> asset_not_found(const std::string& sha256);

/// Stores an asset without an owner; if it exists, its retention starts again.
[[nodiscard]] Status insert_asset(Database& database, const Asset& asset, std::int64_t now_ms);

/// Deletes the row of an asset if it has no owner and no job uses it.
[[nodiscard]] Status delete_unused_asset(Database& database, const std::string& sha256);

/// Returns whether the asset's file exists with the right size.
[[nodiscard]] bool has_file(const Layout& layout, const Asset& asset);

/// Deletes an asset's file if it has no row, in one transaction, so that nobody can create the same
/// asset meanwhile. If this fails, the file remains, and the next start sets it aside.
void discard_unowned_file(Database& database, const Layout& layout, const std::string& sha256);

/// Returns the size of a file in bytes; 0 if it does not exist.
[[nodiscard]] std::int64_t size_on_disk(const std::filesystem::path& path);

}  // namespace hydroprint::daemon
