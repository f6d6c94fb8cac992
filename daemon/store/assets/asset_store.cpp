#include "daemon/store/assets/asset_store.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include "daemon/platform/durable_file.h"
#include "daemon/platform/resource_names.h"
#include "daemon/store/assets/asset_rows.h"
#include "daemon/store/job_rows.h"

namespace hydroprint::daemon {
namespace {

// The owner of a job that uses an asset must remain an owner of the asset; otherwise its bytes
// might not count towards any quota.
Status check_is_not_used_by(Database& database, const std::string& sha256,
                            const std::string& owner) {
  HP_ASSIGN_OR_RETURN(
      const auto jobs,
      select_numbers(database,
                     "SELECT jobs.id FROM job_inputs JOIN jobs ON jobs.id=job_inputs.job WHERE "
                     "job_inputs.sha256=? AND jobs.owner=? LIMIT 1",
                     {sha256, owner}));
  if (jobs.empty()) return {};
  return fail(Code::kFailedPrecondition,
              fmt::format("assets/{}: {} uses this file; delete that job first", sha256,
                          job_name(jobs.front())),
              ErrorReason::STATE_FORBIDS);
}

}  // namespace

AssetStore::AssetStore(Database& database, const Layout& layout, Clock clock)
    : database_(database), layout_(layout), clock_(std::move(clock)) {}

Result<Asset> AssetStore::asset_for(const std::string& sha256, const AssetUser& user) {
  HP_ASSIGN_OR_RETURN(const bool may, may_use(database_, sha256, user));
  if (!may) return asset_not_found(sha256);
  HP_ASSIGN_OR_RETURN(Asset asset, select_asset(database_, sha256));
  HP_ASSIGN_OR_RETURN(asset.owners, owners_of(database_, sha256));
  if (!user.is_operator) {
    std::erase_if(asset.owners, [&](const std::string& owner) { return owner != user.name; });
  }
  return asset;
}

bool AssetStore::is_sound(const Asset& asset) {
  return has_file(layout_, asset) && hashes_.of(layout_.asset(asset.sha256)) == asset.sha256;
}

Result<std::vector<Asset>> AssetStore::list(const std::string& after, int limit,
                                            const std::string& owner) {
  std::vector<Asset> assets;
  const std::string selected = owner.empty()
                                   ? "assets WHERE sha256>?1"
                                   : "asset_owners AS o JOIN assets USING(sha256) WHERE o.owner=?2 "
                                     "AND o.sha256>?1";
  HP_RETURN_IF_ERROR(
      database_.each("SELECT sha256, size, media_type, assets.create_ms FROM " + selected +
                         " ORDER BY sha256 LIMIT ?3",
                     {after, owner, std::int64_t{limit}}, [&](const DbRow& row) {
                       assets.push_back({row.text(0), row.integer(1), row.text(2), row.integer(3)});
                     }));
  for (Asset& asset : assets) {
    HP_ASSIGN_OR_RETURN(asset.owners, owners_of(database_, asset.sha256));
  }
  return assets;
}

Status AssetStore::remove(const std::string& sha256, const AssetUser& user) {
  const Status done = database_.transaction([&]() -> Status {
    HP_ASSIGN_OR_RETURN(const Asset asset, asset_for(sha256, user));
    if (!user.is_operator) {
      if (asset.owners.empty()) return asset_not_found(sha256);  // visible only through a job
      HP_RETURN_IF_ERROR(check_is_not_used_by(database_, sha256, user.name));
      HP_RETURN_IF_ERROR(database_.run("DELETE FROM asset_owners WHERE owner=? AND sha256=?",
                                       {user.name, sha256}));
      return delete_unused_asset(database_, sha256);
    }
    HP_ASSIGN_OR_RETURN(
        const auto jobs,
        select_numbers(database_,
                       "SELECT jobs.id FROM jobs JOIN job_inputs ON job_inputs.job=jobs.id "
                       "WHERE job_inputs.sha256=? AND jobs.state IN (1,3,4,8) LIMIT 1",
                       {sha256}));
    if (!jobs.empty()) {
      return fail(Code::kFailedPrecondition,
                  fmt::format("assets/{} is needed by {}; cancel that job or wait until it ends",
                              sha256, job_name(jobs.front())),
                  ErrorReason::STATE_FORBIDS);
    }
    return database_.run("DELETE FROM assets WHERE sha256=?", {sha256});
  });
  HP_RETURN_IF_ERROR(done);
  discard_unowned_file(database_, layout_, sha256);
  return {};
}

Result<Asset> AssetStore::adopt(const std::filesystem::path& file, const Asset& as) {
  const auto final_path = layout_.asset(as.sha256);
  HP_RETURN_IF_ERROR(make_folder(final_path.parent_path()));
  (void)is_sound(as);  // reads the file before the transaction
  const Status done = database_.transaction([&]() -> Status {
    const auto known = select_asset(database_, as.sha256);
    if (known && is_sound(*known)) return insert_asset(database_, as, clock_());
    discard(final_path);  // damaged, or left by a crash
    HP_RETURN_IF_ERROR(link_or_copy(file, final_path));
    ::chmod(final_path.c_str(), 0400);
    HP_RETURN_IF_ERROR(sync_path(final_path));
    HP_RETURN_IF_ERROR(sync_path(final_path.parent_path()));
    return insert_asset(database_, as, clock_());
  });
  if (!done) discard_unowned_file(database_, layout_, as.sha256);
  HP_RETURN_IF_ERROR(done);
  return select_asset(database_, as.sha256);
}

}  // namespace hydroprint::daemon
