#include "daemon/store/assets/uploads.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>

#include "daemon/platform/durable_file.h"
#include "daemon/platform/resource_names.h"
#include "daemon/store/assets/asset_rows.h"
#include "daemon/store/idempotency.h"
#include "daemon/store/job_rows.h"

namespace hydroprint::daemon {

tl::unexpected<Error> asset_too_large(Code code, std::int64_t max_bytes) {
  auto error = fail(code,
                    fmt::format("the file has more than {} bytes; do not exceed the announced size "
                                "or assets.max_mib",
                                max_bytes),
                    ErrorReason::ASSET_TOO_LARGE);
  error.value().metadata["max_bytes"] = fmt::to_string(max_bytes);
  return error;
}

Uploads::Uploads(Database& database, AssetStore& assets, const Layout& layout,
                 const UploadOptions& options, Clock clock)
    : database_(database),
      assets_(assets),
      layout_(layout),
      options_(options),
      clock_(std::move(clock)) {}

// Only permitted users learn that bytes are stored or being uploaded. Other users upload them,
// which proves that they have them.
Result<AssetOrUpload> Uploads::start(const Upload& wanted, const AssetUser& user,
                                     const RequestKey& request) {
  if (wanted.size_bytes > options_.max_bytes) {
    return asset_too_large(Code::kResourceExhausted, options_.max_bytes);
  }
  if (const auto known = assets_.asset_for(wanted.sha256, user)) {
    (void)assets_.is_sound(*known);  // reads the file before the transaction
  }
  std::string id;
  const Status done = database_.transaction([&]() -> Status {
    const std::int64_t now = clock_();
    HP_ASSIGN_OR_RETURN(const auto earlier, earlier_result(database_, user.name, request, now));
    const auto known = assets_.asset_for(wanted.sha256, user);
    if (known && assets_.is_sound(*known)) return take(*known, user.name);
    if (earlier && get(*earlier, user.name)) {
      id = *earlier;
      return {};
    }
    HP_RETURN_IF_ERROR(check_byte_quota(database_, user.name, options_.quota, wanted.size_bytes));
    HP_RETURN_IF_ERROR(check_free_space(layout_.root, wanted.size_bytes + options_.min_free_bytes));
    HP_ASSIGN_OR_RETURN(const auto open,
                        select_numbers(database_, "SELECT count(*) FROM uploads", {}));
    if (open.front() >= options_.max_open) {
      return fail(Code::kResourceExhausted,
                  "too many uploads are open; finish some, or try again later",
                  ErrorReason::UPLOADS_FULL);
    }
    id = make_token();
    HP_RETURN_IF_ERROR(database_.run("INSERT INTO uploads VALUES (?,?,?,?,?,?)",
                                     {id, wanted.sha256, wanted.size_bytes, wanted.media_type,
                                      now + options_.expires_ms, user.name}));
    return remember_result(database_, user.name, request, id, now);
  });
  HP_RETURN_IF_ERROR(done);
  if (!id.empty()) {
    HP_ASSIGN_OR_RETURN(Upload made, get(id, user.name));
    return AssetOrUpload(std::move(made));
  }
  HP_ASSIGN_OR_RETURN(Asset known, assets_.asset_for(wanted.sha256, user));
  return AssetOrUpload(std::move(known));
}

// Makes the user an owner of the asset.
Status Uploads::take(const Asset& asset, const std::string& owner) {
  const auto& owners = asset.owners;
  if (std::find(owners.begin(), owners.end(), owner) == owners.end()) {
    HP_RETURN_IF_ERROR(check_byte_quota(database_, owner, options_.quota, asset.size_bytes));
    HP_RETURN_IF_ERROR(add_owner(database_, asset.sha256, owner, clock_()));
  }
  return database_.run("UPDATE assets SET use_ms=? WHERE sha256=?", {clock_(), asset.sha256});
}

Result<Upload> Uploads::get(const std::string& id, const std::string& owner) {
  Upload upload;
  HP_RETURN_IF_ERROR(database_.each(
      "SELECT id, sha256, size, media_type, expire_ms, owner FROM uploads WHERE id=? AND "
      "expire_ms>? AND owner=?",
      {id, clock_(), owner}, [&](const DbRow& row) {
        upload = {row.text(0), row.text(1),    row.integer(2), 0,
                  row.text(3), row.integer(4), row.text(5)};
      }));
  if (upload.id.empty()) {
    return fail(Code::kNotFound,
                "uploads/" + id + " does not exist, or has expired; start the upload again",
                ErrorReason::UPLOAD_NOT_FOUND);
  }
  upload.received_bytes = std::min(size_on_disk(layout_.upload(id)), upload.size_bytes);
  return upload;
}

Status Uploads::claim(const std::string& id) {
  const std::lock_guard lock(busy_mutex_);
  if (busy_.insert(id).second) return {};
  return fail(Code::kAborted,
              "uploads/" + id + ": another call is writing to this upload; wait until it ends",
              ErrorReason::UPLOAD_BUSY);
}

void Uploads::release(const std::string& id) {
  const std::lock_guard lock(busy_mutex_);
  busy_.erase(id);
}

Result<Asset> Uploads::complete(const Upload& upload) {
  const auto part = layout_.upload(upload.id), final_path = layout_.asset(upload.sha256);
  HP_RETURN_IF_ERROR(make_folder(final_path.parent_path()));
  const Status done = database_.transaction([&]() -> Status {
    HP_RETURN_IF_ERROR(database_.run("DELETE FROM uploads WHERE id=?", {upload.id}));
    HP_RETURN_IF_ERROR(
        check_byte_quota(database_, upload.owner, options_.quota, upload.size_bytes));
    ::chmod(part.c_str(), 0400);
    HP_RETURN_IF_ERROR(publish(part, final_path));
    HP_RETURN_IF_ERROR(insert_asset(
        database_, {upload.sha256, upload.size_bytes, upload.media_type, 0}, clock_()));
    return add_owner(database_, upload.sha256, upload.owner, clock_());
  });
  HP_RETURN_IF_ERROR(done);
  return assets_.asset_for(upload.sha256, {upload.owner, false});
}

// Deletes the files first, since deleting the row may need their space.
void Uploads::give_up(const Upload& upload) {
  discard(layout_.upload(upload.id));
  discard_unowned_file(database_, layout_, upload.sha256);
  (void)database_.run("DELETE FROM uploads WHERE id=?", {upload.id});
}

}  // namespace hydroprint::daemon
