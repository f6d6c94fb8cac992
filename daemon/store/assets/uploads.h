#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <set>
#include <string>

#include "daemon/platform/clock.h"
#include "daemon/store/assets/asset_store.h"
#include "daemon/store/quota.h"

namespace hydroprint::daemon {

/// Limits of uploads.
struct UploadOptions {
  std::int64_t max_bytes = 1LL << 30;
  std::int64_t max_open = 64;
  std::int64_t expires_ms = 24LL * 3600 * 1000;
  std::int64_t min_free_bytes = 512LL << 20;
  Quota quota = {};  ///< for each owner
};

/// Uploads of assets. An asset's row is written after the bytes are hashed and synced under their
/// final name. Thread-safe.
class Uploads {
 public:
  Uploads(Database& database, AssetStore& assets, const Layout& layout,
          const UploadOptions& options, Clock clock);

  /// Returns the asset if its bytes are stored, not damaged, and the user may use them, and makes
  /// the user an owner. Otherwise starts an upload, or returns the one that an earlier request with
  /// the same id started.
  /// @return kResourceExhausted: ASSET_TOO_LARGE, DISK_FULL, UPLOADS_FULL, QUOTA_EXCEEDED;
  /// kInvalidArgument, REQUEST_ID_REUSED
  [[nodiscard]] Result<AssetOrUpload> start(const Upload& wanted, const AssetUser& user,
                                            const RequestKey& request);
  /// Returns an upload of this owner. Errors: kNotFound, UPLOAD_NOT_FOUND.
  [[nodiscard]] Result<Upload> get(const std::string& id, const std::string& owner);

  // The following is for UploadWriter.

  /// Reserves an upload for one writer. Errors: kAborted, UPLOAD_BUSY.
  [[nodiscard]] Status claim(const std::string& id);
  void release(const std::string& id);
  /// Returns the file that receives the bytes.
  [[nodiscard]] std::filesystem::path file(const std::string& id) const {
    return layout_.upload(id);
  }
  /// Turns an upload with verified bytes into an asset. Errors: kResourceExhausted: DISK_FULL,
  /// QUOTA_EXCEEDED.
  [[nodiscard]] Result<Asset> complete(const Upload& upload);
  /// Deletes an upload.
  void give_up(const Upload& upload);

 private:
  [[nodiscard]] Status take(const Asset& asset, const std::string& owner);

  Database& database_;
  AssetStore& assets_;
  Layout layout_;
  UploadOptions options_;
  Clock clock_;
  std::mutex busy_mutex_;
  std::set<std::string> busy_;  // ids of uploads that have a writer
};

/// Returns the error ASSET_TOO_LARGE, with metadata `max_bytes`.
[[nodiscard]] tl::unexpected<Error> asset_too_large(Code code, std::int64_t max_bytes);

}  // namespace hydroprint::daemon
