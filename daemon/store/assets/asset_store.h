#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "daemon/platform/clock.h"
#include "daemon/platform/file_hashes.h"
#include "daemon/store/asset.h"
#include "daemon/store/assets/asset_owners.h"
#include "daemon/store/database/database.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::daemon {

/// Stores assets. An asset exists once its row is stored. Several owners may have uploaded the same
/// asset (asset_owners.h). Thread-safe.
class AssetStore {
 public:
  AssetStore(Database& database, const Layout& layout, Clock clock);

  /// Returns an asset. Operators see all its owners, other users only themselves. Errors:
  /// ASSET_NOT_FOUND, also if the user may not use the asset.
  [[nodiscard]] Result<Asset> asset_for(const std::string& sha256, const AssetUser& user);
  /// Returns whether the asset's file has its content. Reads the whole file, unless it was read
  /// since it last changed, so call this before a transaction that calls it too.
  [[nodiscard]] bool is_sound(const Asset& asset);
  /// Adds a complete, synced file with the hash `as.sha256` as an asset without an owner, unless
  /// the asset exists and is_sound(). The file itself remains; it may become read-only, because the
  /// asset may be a hard link to it.
  /// @return kResourceExhausted, DISK_FULL
  [[nodiscard]] Result<Asset> adopt(const std::filesystem::path& file, const Asset& as);
  /// Returns the assets with hashes after `after`, sorted by hash, with their owners. Lists those
  /// of one owner, or all if `owner` is empty.
  [[nodiscard]] Result<std::vector<Asset>> list(const std::string& after, int limit,
                                                const std::string& owner);
  /// Deletes an asset. An operator deletes it for everybody. Other users only stop owning it, which
  /// is possible if none of their jobs uses it; it is deleted once it has no owner and no job uses
  /// it.
  /// @return kFailedPrecondition, STATE_FORBIDS if one of the user's jobs uses the asset (for an
  /// operator: an unfinished job of any user); ASSET_NOT_FOUND
  [[nodiscard]] Status remove(const std::string& sha256, const AssetUser& user);

 private:
  Database& database_;
  Layout layout_;
  Clock clock_;
  FileHashes hashes_;
};

}  // namespace hydroprint::daemon
