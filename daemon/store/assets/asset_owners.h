#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/store/database/database.h"
#include "daemon/store/job.h"

namespace hydroprint::daemon {

/// A user of assets.
struct AssetUser {
  std::string name;
  bool is_operator = false;  ///< operators may use all assets
};

/// Returns whether a user may use the bytes with that hash. Operators may, as may users who
/// uploaded them or who can see a job that uses them (their own or a shared one).
[[nodiscard]] Result<bool> may_use(Database& database, const std::string& sha256,
                                   const AssetUser& user);

/// Returns kFailedPrecondition, ASSET_MISSING for input files that a user may not use. The error is
/// the same if the file does not exist.
[[nodiscard]] Status check_may_use(Database& database, const std::vector<InputFile>& inputs,
                                   const AssetUser& user);

/// Returns the names of an asset's owners.
[[nodiscard]] Result<std::vector<std::string>> owners_of(Database& database,
                                                         const std::string& sha256);

/// Adds an owner to an asset. Not an error if the user already is an owner.
[[nodiscard]] Status add_owner(Database& database, const std::string& sha256,
                               const std::string& owner, std::int64_t now_ms);

}  // namespace hydroprint::daemon
