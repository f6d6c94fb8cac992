#include "daemon/store/asset_store.h"

#include <sys/stat.h>

#include <algorithm>

#include "daemon/platform/resource_names.h"
#include "daemon/store/asset_bytes.h"
#include "daemon/store/idempotency.h"
#include "daemon/store/job_rows.h"

namespace hydroprint::daemon {
namespace {

tl::unexpected<Error> asset_not_found(const std::string& sha256) {
  return fail(Code::kNotFound, "assets/" + sha256 + " is not on the daemon; upload it",
              "ASSET_NOT_FOUND");
}

// Checks that no job of the owner uses the asset. Otherwise its bytes would not count towards any
// owner's quota.
Status check_is_not_used_by(Database& database, const std::string& sha256,
                            const std::string& owner) {
  HP_ASSIGN_OR_RETURN(
      const auto jobs,
      select_numbers(database,
                     "SELECT jobs.id FROM job_inputs JOIN jobs ON jobs.id=job_inputs.job WHERE "
                     "job_inputs.sha256=? AND jobs.owner=? LIMIT 1",
                     {sha256, owner}));
  if (jobs.empty()) return {};
  return fail(
      Code::kFailedPrecondition,
      "assets/" + sha256 + ": " + job_name(jobs.front()) + " uses it; delete that job first",
      "STATE_FORBIDS");
}

}  // namespace

tl::unexpected<Error> asset_too_large(Code code, std::int64_t max_bytes) {
  auto error = fail(code,
                    "more than " + std::to_string(max_bytes) +
                        " bytes; send the announced size, within assets.max_mib",
                    "ASSET_TOO_LARGE");
  error.value().metadata["max_bytes"] = std::to_string(max_bytes);
  return error;
}

std::int64_t size_on_disk(const std::filesystem::path& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  return error ? 0 : static_cast<std::int64_t>(size);
}

AssetStore::AssetStore(Database& database, const Layout& layout, const AssetStoreOptions& options,
                       Clock clock)
    : database_(database), layout_(layout), options_(options), clock_(std::move(clock)) {}

// Only users with access learn that bytes are stored or being uploaded. Other users upload them
// again, which proves that they have them.
Result<AssetOrUpload> AssetStore::start(const Upload& wanted, const AssetUser& user,
                                        const RequestKey& request) {
  if (wanted.size_bytes > options_.max_bytes) {
    return asset_too_large(Code::kResourceExhausted, options_.max_bytes);
  }
  std::string id;
  const Status done = database_.transaction([&]() -> Status {
    const std::int64_t now = clock_();
    HP_ASSIGN_OR_RETURN(const auto earlier, earlier_result(database_, user.name, request, now));
    const auto known = asset_for(wanted.sha256, user);
    if (known && has_file(*known)) return take(*known, user.name);
    if (earlier && upload(*earlier, user.name)) {
      id = *earlier;
      return {};
    }
    HP_RETURN_IF_ERROR(check_byte_quota(database_, user.name, options_.quota, wanted.size_bytes));
    HP_RETURN_IF_ERROR(check_free_space(layout_.root, wanted.size_bytes + options_.min_free_bytes));
    HP_ASSIGN_OR_RETURN(const auto open,
                        select_numbers(database_, "SELECT count(*) FROM uploads", {}));
    if (open.front() >= options_.max_open_uploads) {
      return fail(Code::kResourceExhausted,
                  "too many uploads are open; finish some, or try again later", "UPLOADS_FULL");
    }
    id = make_token();
    HP_RETURN_IF_ERROR(database_.run("INSERT INTO uploads VALUES (?,?,?,?,?,?)",
                                     {id, wanted.sha256, wanted.size_bytes, wanted.media_type,
                                      now + options_.upload_expires_ms, user.name}));
    return remember_result(database_, user.name, request, id, now);
  });
  HP_RETURN_IF_ERROR(done);
  if (!id.empty()) {
    HP_ASSIGN_OR_RETURN(Upload made, upload(id, user.name));
    return AssetOrUpload(std::move(made));
  }
  HP_ASSIGN_OR_RETURN(Asset known, asset_for(wanted.sha256, user));
  return AssetOrUpload(std::move(known));
}

// Adds the user to the owners of the asset.
Status AssetStore::take(const Asset& asset, const std::string& owner) {
  const auto& owners = asset.owners;
  if (std::find(owners.begin(), owners.end(), owner) == owners.end()) {
    HP_RETURN_IF_ERROR(check_byte_quota(database_, owner, options_.quota, asset.size_bytes));
    HP_RETURN_IF_ERROR(add_owner(database_, asset.sha256, owner, clock_()));
  }
  return database_.run("UPDATE assets SET use_ms=? WHERE sha256=?", {clock_(), asset.sha256});
}

Result<Upload> AssetStore::upload(const std::string& id, const std::string& owner) {
  Upload upload;
  HP_RETURN_IF_ERROR(database_.each(
      "SELECT id, sha256, size, media_type, expire_ms, owner FROM uploads WHERE id=? AND "
      "expire_ms>? AND owner=?",
      {id, clock_(), owner}, [&](const DbRow& row) {
        upload = {row.text(0), row.text(1),    row.integer(2), 0,
                  row.text(3), row.integer(4), row.text(5)};
      }));
  if (upload.id.empty()) {
    return fail(Code::kNotFound, "uploads/" + id + ": there is no such upload; start it again",
                "UPLOAD_NOT_FOUND");
  }
  upload.received_bytes = std::min(size_on_disk(layout_.upload(id)), upload.size_bytes);
  return upload;
}

bool AssetStore::has_file(const Asset& asset) const {
  const auto path = layout_.asset(asset.sha256);
  return std::filesystem::exists(path) && size_on_disk(path) == asset.size_bytes;
}

Result<Asset> AssetStore::asset(const std::string& sha256) {
  Asset asset;
  HP_RETURN_IF_ERROR(
      database_.each("SELECT sha256, size, media_type, create_ms FROM assets WHERE sha256=?",
                     {sha256}, [&](const DbRow& row) {
                       asset = {row.text(0), row.integer(1), row.text(2), row.integer(3)};
                     }));
  if (asset.sha256.empty()) return asset_not_found(sha256);
  return asset;
}

Result<Asset> AssetStore::asset_for(const std::string& sha256, const AssetUser& user) {
  HP_ASSIGN_OR_RETURN(const bool may, may_use(database_, sha256, user));
  if (!may) return asset_not_found(sha256);
  HP_ASSIGN_OR_RETURN(Asset asset, this->asset(sha256));
  HP_ASSIGN_OR_RETURN(asset.owners, owners_of(database_, sha256));
  if (!user.is_operator) {
    std::erase_if(asset.owners, [&](const std::string& owner) { return owner != user.name; });
  }
  return asset;
}

Status AssetStore::check_use(const std::vector<InputFile>& inputs, const AssetUser& user) {
  return check_may_use(database_, inputs, user);
}

Result<std::vector<Asset>> AssetStore::list(const std::string& after, int limit,
                                            const std::string& owner) {
  std::vector<Asset> assets;
  HP_RETURN_IF_ERROR(database_.each(
      "SELECT sha256, size, media_type, create_ms FROM assets WHERE sha256>?1 AND (?2='' OR EXISTS "
      "(SELECT 1 FROM asset_owners WHERE owner=?2 AND sha256=assets.sha256)) ORDER BY sha256 "
      "LIMIT ?3",
      {after, owner, std::int64_t{limit}}, [&](const DbRow& row) {
        assets.push_back({row.text(0), row.integer(1), row.text(2), row.integer(3)});
      }));
  for (Asset& asset : assets) {
    HP_ASSIGN_OR_RETURN(asset.owners, owners_of(database_, asset.sha256));
  }
  return assets;
}

// Deletes the row of an asset that has no owner and is not used by a job.
Status AssetStore::delete_unused(const std::string& sha256) {
  return database_.run(
      "DELETE FROM assets WHERE sha256=?1 AND NOT EXISTS (SELECT 1 FROM asset_owners WHERE "
      "sha256=?1) AND NOT EXISTS (SELECT 1 FROM job_inputs WHERE sha256=?1)",
      {sha256});
}

Status AssetStore::remove(const std::string& sha256, const AssetUser& user) {
  const Status done = database_.transaction([&]() -> Status {
    HP_ASSIGN_OR_RETURN(const Asset asset, asset_for(sha256, user));
    if (!user.is_operator) {
      if (asset.owners.empty()) return asset_not_found(sha256);  // from a job that the user may see
      HP_RETURN_IF_ERROR(check_is_not_used_by(database_, sha256, user.name));
      HP_RETURN_IF_ERROR(database_.run("DELETE FROM asset_owners WHERE owner=? AND sha256=?",
                                       {user.name, sha256}));
      return delete_unused(sha256);
    }
    HP_ASSIGN_OR_RETURN(
        const auto jobs,
        select_numbers(database_,
                       "SELECT jobs.id FROM jobs JOIN job_inputs ON job_inputs.job=jobs.id "
                       "WHERE job_inputs.sha256=? AND jobs.state IN (1,3,4,8) LIMIT 1",
                       {sha256}));
    if (!jobs.empty()) {
      return fail(Code::kFailedPrecondition,
                  "assets/" + sha256 + " is used by " + job_name(jobs.front()) +
                      "; cancel the job or wait until it ends",
                  "STATE_FORBIDS");
    }
    return database_.run("DELETE FROM assets WHERE sha256=?", {sha256});
  });
  HP_RETURN_IF_ERROR(done);
  discard_unowned(sha256);
  return {};
}

// Deletes an asset's file if it has no row, in one transaction, so that the same asset cannot be
// created meanwhile. If this fails, the next start deletes the file.
void AssetStore::discard_unowned(const std::string& sha256) {
  (void)database_.transaction([&]() -> Status {
    const auto owner = asset(sha256);
    if (!owner && owner.error().code == Code::kNotFound) discard(layout_.asset(sha256));
    return {};
  });
}

Status AssetStore::insert(const Asset& asset) {
  return database_.run(
      "INSERT INTO assets(sha256, size, media_type, create_ms, use_ms) VALUES (?1,?2,?3,?4,?4) ON "
      "CONFLICT(sha256) DO UPDATE SET use_ms=excluded.use_ms",
      {asset.sha256, asset.size_bytes, asset.media_type, clock_()});
}

Result<Asset> AssetStore::complete(const Upload& upload) {
  const auto part = layout_.upload(upload.id), final_path = layout_.asset(upload.sha256);
  HP_RETURN_IF_ERROR(make_folder(final_path.parent_path()));
  const Status done = database_.transaction([&]() -> Status {
    HP_RETURN_IF_ERROR(database_.run("DELETE FROM uploads WHERE id=?", {upload.id}));
    HP_RETURN_IF_ERROR(
        check_byte_quota(database_, upload.owner, options_.quota, upload.size_bytes));
    ::chmod(part.c_str(), 0400);
    HP_RETURN_IF_ERROR(publish(part, final_path));
    HP_RETURN_IF_ERROR(insert({upload.sha256, upload.size_bytes, upload.media_type, 0}));
    return add_owner(database_, upload.sha256, upload.owner, clock_());
  });
  HP_RETURN_IF_ERROR(done);
  return asset_for(upload.sha256, {upload.owner, false});
}

// Deletes the files first, because deleting the row may need their space.
void AssetStore::give_up(const Upload& upload) {
  discard(layout_.upload(upload.id));
  discard_unowned(upload.sha256);
  (void)database_.run("DELETE FROM uploads WHERE id=?", {upload.id});
}

Result<Asset> AssetStore::adopt(const std::filesystem::path& file, const Asset& as) {
  const auto final_path = layout_.asset(as.sha256);
  HP_RETURN_IF_ERROR(make_folder(final_path.parent_path()));
  const Status done = database_.transaction([&]() -> Status {
    if (const auto known = asset(as.sha256); known && has_file(*known)) return insert(as);
    discard(final_path);  // left, perhaps incomplete, by a crash
    HP_RETURN_IF_ERROR(link_or_copy(file, final_path));
    ::chmod(final_path.c_str(), 0400);
    HP_RETURN_IF_ERROR(sync_path(final_path));
    HP_RETURN_IF_ERROR(sync_path(final_path.parent_path()));
    return insert(as);
  });
  if (!done) discard_unowned(as.sha256);
  HP_RETURN_IF_ERROR(done);
  return asset(as.sha256);
}

}  // namespace hydroprint::daemon
