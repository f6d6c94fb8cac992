#include "daemon/store/assets/asset_rows.h"

#include <system_error>

#include "daemon/platform/durable_file.h"

namespace hydroprint::daemon {

Result<Asset> select_asset(Database& database, const std::string& sha256) {
  Asset asset;
  HP_RETURN_IF_ERROR(
      database.each("SELECT sha256, size, media_type, create_ms FROM assets WHERE sha256=?",
                    {sha256}, [&](const DbRow& row) {
                      asset = {row.text(0), row.integer(1), row.text(2), row.integer(3)};
                    }));
  if (asset.sha256.empty()) return asset_not_found(sha256);
  return asset;
}

tl::unexpected<Error> asset_not_found(const std::string& sha256) {
  return fail(Code::kNotFound, "assets/" + sha256 + " does not exist; upload the file",
              ErrorReason::ASSET_NOT_FOUND);
}

Status insert_asset(Database& database, const Asset& asset, std::int64_t now_ms) {
  return database.run(
      "INSERT INTO assets(sha256, size, media_type, create_ms, use_ms) VALUES (?1,?2,?3,?4,?4) ON "
      "CONFLICT(sha256) DO UPDATE SET use_ms=excluded.use_ms",
      {asset.sha256, asset.size_bytes, asset.media_type, now_ms});
}

Status delete_unused_asset(Database& database, const std::string& sha256) {
  return database.run(
      "DELETE FROM assets WHERE sha256=?1 AND NOT EXISTS (SELECT 1 FROM asset_owners WHERE "
      "sha256=?1) AND NOT EXISTS (SELECT 1 FROM job_inputs WHERE sha256=?1)",
      {sha256});
}

bool has_file(const Layout& layout, const Asset& asset) {
  const auto path = layout.asset(asset.sha256);
  return std::filesystem::exists(path) && size_on_disk(path) == asset.size_bytes;
}

void discard_unowned_file(Database& database, const Layout& layout, const std::string& sha256) {
  (void)database.transaction([&]() -> Status {
    const auto asset = select_asset(database, sha256);
    if (!asset && asset.error().code == Code::kNotFound) discard(layout.asset(sha256));
    return {};
  });
}

std::int64_t size_on_disk(const std::filesystem::path& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  return error ? 0 : static_cast<std::int64_t>(size);
}

}  // namespace hydroprint::daemon
