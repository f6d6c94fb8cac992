#include "daemon/store/assets/asset_retention.h"

#include <algorithm>
#include <set>

#include "daemon/platform/durable_file.h"
#include "daemon/platform/log.h"
#include "daemon/store/assets/asset_owners.h"
#include "daemon/store/assets/asset_rows.h"
#include "daemon/store/database/retention_clock.h"
#include "daemon/store/set_aside.h"

namespace hydroprint::daemon {

AssetRetention::AssetRetention(Database& database, const Layout& layout,
                               std::int64_t keep_unused_ms, Clock clock)
    : database_(database),
      layout_(layout),
      keep_unused_ms_(keep_unused_ms),
      clock_(std::move(clock)) {}

Status AssetRetention::purge() {
  HP_RETURN_IF_ERROR(follow_clock(database_, clock_()));
  const std::int64_t now_ms = clock_();
  const Status done = database_.transaction([&]() -> Status {
    std::vector<std::string> expired;
    HP_RETURN_IF_ERROR(database_.each("SELECT id FROM uploads WHERE expire_ms<=?", {now_ms},
                                      [&](const DbRow& row) { expired.push_back(row.text(0)); }));
    for (const std::string& id : expired) discard(layout_.upload(id));
    return database_.run("DELETE FROM uploads WHERE expire_ms<=?", {now_ms});
  });
  HP_RETURN_IF_ERROR(done);
  return keep_unused_ms_ > 0 ? purge_unused() : Status();
}

Status AssetRetention::purge_unused() {
  const std::int64_t before_ms = clock_() - keep_unused_ms_;
  std::vector<std::string> old;
  HP_RETURN_IF_ERROR(database_.each(
      "SELECT sha256 FROM assets WHERE use_ms<=? AND NOT EXISTS (SELECT 1 FROM job_inputs WHERE "
      "job_inputs.sha256=assets.sha256) ORDER BY use_ms",
      {before_ms}, [&](const DbRow& row) { old.push_back(row.text(0)); }));
  for (const std::string& sha256 : old) {
    bool is_gone = false;
    const Status done = database_.transaction([&]() -> Status {
      HP_RETURN_IF_ERROR(database_.run(
          "DELETE FROM asset_owners WHERE sha256=?1 AND EXISTS (SELECT 1 FROM assets WHERE "
          "sha256=?1 AND use_ms<=?2) AND NOT EXISTS (SELECT 1 FROM job_inputs WHERE sha256=?1)",
          {sha256, before_ms}));
      HP_RETURN_IF_ERROR(delete_unused_asset(database_, sha256));
      is_gone = database_.changes() > 0;
      return {};
    });
    HP_RETURN_IF_ERROR(done);
    if (!is_gone) continue;
    discard_unowned_file(database_, layout_, sha256);
    log(LogLevel::kInfo, "asset_deleted", {{"asset", sha256}, {"why", "unused for too long"}});
  }
  return {};
}

// Handles a crash during Uploads::complete(): a verified file has its final name but no row. If
// several uploads have the same hash, the owner is unknown, so the clients must upload the file
// again.
Status AssetRetention::adopt_completed_uploads() {
  std::vector<Upload> open;
  HP_RETURN_IF_ERROR(database_.each(
      "SELECT id, sha256, size, media_type, owner FROM uploads", {}, [&](const DbRow& row) {
        open.push_back({row.text(0), row.text(1), row.integer(2), 0, row.text(3), 0, row.text(4)});
      }));
  for (const Upload& upload : open) {
    const auto path = layout_.asset(upload.sha256);
    const auto senders = std::count_if(open.begin(), open.end(), [&](const Upload& other) {
      return other.sha256 == upload.sha256;
    });
    if (senders != 1 || select_asset(database_, upload.sha256) ||
        std::filesystem::exists(layout_.upload(upload.id)) || !std::filesystem::exists(path)) {
      continue;
    }
    const auto hash = sha256_of_file(path);
    if (!hash || *hash != upload.sha256) continue;
    HP_RETURN_IF_ERROR(insert_asset(
        database_, {upload.sha256, upload.size_bytes, upload.media_type, 0}, clock_()));
    HP_RETURN_IF_ERROR(add_owner(database_, upload.sha256, upload.owner, clock_()));
    HP_RETURN_IF_ERROR(database_.run("DELETE FROM uploads WHERE id=?", {upload.id}));
  }
  return {};
}

// Keeps the rows of missing files: the folder may be absent only temporarily, and a new upload
// restores the asset.
Status AssetRetention::log_missing_files() {
  int missing = 0;
  HP_RETURN_IF_ERROR(database_.each("SELECT sha256, size FROM assets", {}, [&](const DbRow& row) {
    missing += has_file(layout_, {row.text(0), row.integer(1), "", 0}) ? 0 : 1;
  }));
  if (missing == 0) return {};
  log(LogLevel::kError, "asset_files_missing",
      {{"count", missing},
       {"folder", layout_.assets().string()},
       {"message",
        "jobs that need these files fail until they are uploaded again, or the folder is "
        "restored and the daemon is restarted"}});
  return {};
}

Status AssetRetention::sweep() {
  HP_RETURN_IF_ERROR(make_folder(layout_.uploads()));
  HP_RETURN_IF_ERROR(make_folder(layout_.assets()));
  HP_RETURN_IF_ERROR(database_.transaction([&] { return adopt_completed_uploads(); }));
  HP_RETURN_IF_ERROR(log_missing_files());
  std::vector<std::filesystem::path> unknown;
  std::error_code ignored;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(layout_.assets(), ignored)) {
    const auto& path = entry.path();
    const std::string sha256 = path.parent_path().filename().string() + path.filename().string();
    if (!entry.is_directory() && !select_asset(database_, sha256)) unknown.push_back(path);
  }
  std::set<std::string> open;
  HP_RETURN_IF_ERROR(database_.each("SELECT id FROM uploads", {},
                                    [&](const DbRow& row) { open.insert(row.text(0)); }));
  for (const auto& entry : std::filesystem::directory_iterator(layout_.uploads(), ignored)) {
    if (!open.contains(entry.path().filename().string())) unknown.push_back(entry.path());
  }
  SetAside set_aside(layout_, clock_());
  for (const auto& path : unknown) HP_RETURN_IF_ERROR(set_aside.move(path));
  return {};
}

}  // namespace hydroprint::daemon
