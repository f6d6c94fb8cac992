#include "daemon/store/assets/asset_owners.h"

#include "daemon/store/asset.h"
#include "daemon/store/job_rows.h"

namespace hydroprint::daemon {

Result<bool> may_use(Database& database, const std::string& sha256, const AssetUser& user) {
  if (user.is_operator) return true;
  HP_ASSIGN_OR_RETURN(
      const auto found,
      select_numbers(database,
                     "SELECT 1 FROM asset_owners WHERE owner=?1 AND sha256=?2 UNION ALL "
                     "SELECT 1 FROM job_inputs JOIN jobs ON jobs.id=job_inputs.job WHERE "
                     "job_inputs.sha256=?2 AND (jobs.owner=?1 OR jobs.shared=1) LIMIT 1",
                     {user.name, sha256}));
  return !found.empty();
}

Status check_may_use(Database& database, const std::vector<InputFile>& inputs,
                     const AssetUser& user) {
  for (const InputFile& input : inputs) {
    HP_ASSIGN_OR_RETURN(const bool may, may_use(database, input.sha256, user));
    if (!may) return asset_missing(input);
  }
  return {};
}

Result<std::vector<std::string>> owners_of(Database& database, const std::string& sha256) {
  std::vector<std::string> owners;
  HP_RETURN_IF_ERROR(database.each("SELECT owner FROM asset_owners WHERE sha256=? ORDER BY owner",
                                   {sha256},
                                   [&](const DbRow& row) { owners.push_back(row.text(0)); }));
  return owners;
}

Status add_owner(Database& database, const std::string& sha256, const std::string& owner,
                 std::int64_t now_ms) {
  return database.run("INSERT OR IGNORE INTO asset_owners VALUES (?,?,?)", {owner, sha256, now_ms});
}

}  // namespace hydroprint::daemon
