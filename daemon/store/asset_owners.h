#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/store/database/database.h"
#include "daemon/store/job.h"

namespace hydroprint::daemon {

/// Who uses an asset.
struct AssetUser {
  std::string name;
  bool is_operator = false;  ///< then all assets are theirs to use
};

/// Whether somebody may use the bytes with that hash, if they are here: operators, who uploaded
/// them, and who may see a job that was made of them (their own, or one that is shared).
[[nodiscard]] Result<bool> may_use(Database& database, const std::string& sha256,
                                   const AssetUser& user);

/// Refuses (kFailedPrecondition, ASSET_MISSING) input files that somebody may not use; of those
/// that are not here it says nothing else.
[[nodiscard]] Status check_may_use(Database& database, const std::vector<InputFile>& inputs,
                                   const AssetUser& user);

/// An input file that is not here.
[[nodiscard]] tl::unexpected<Error> asset_missing(const InputFile& input);

/// Whose an asset is, by name.
[[nodiscard]] Result<std::vector<std::string>> owners_of(Database& database,
                                                         const std::string& sha256);

/// No error if it is theirs already.
[[nodiscard]] Status add_owner(Database& database, const std::string& sha256,
                               const std::string& owner, std::int64_t now_ms);

}  // namespace hydroprint::daemon
