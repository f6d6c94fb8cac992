#pragma once

#include <cstdint>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "daemon/platform/clock.h"
#include "daemon/platform/durable_file.h"
#include "daemon/store/asset_owners.h"
#include "daemon/store/database/database.h"
#include "daemon/store/job.h"
#include "daemon/store/quota.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::daemon {

/// A stored file with verified content.
struct Asset {
  std::string sha256;
  std::int64_t size_bytes = 0;
  std::string media_type;
  std::int64_t create_ms = 0;
  std::vector<std::string> owners = {};  ///< names
};

/// A file whose bytes are still being received.
struct Upload {
  std::string id;
  std::string sha256;
  std::int64_t size_bytes = 0;
  std::int64_t received_bytes = 0;
  std::string media_type;
  std::int64_t expire_ms = 0;
  std::string owner = {};
};

/// The state of an upload: the asset once it is complete, otherwise the upload.
using AssetOrUpload = std::variant<Asset, Upload>;

/// Limits of the store.
struct AssetStoreOptions {
  std::int64_t max_bytes = 1LL << 30;
  std::int64_t max_open_uploads = 64;
  std::int64_t upload_expires_ms = 24LL * 3600 * 1000;
  std::int64_t min_free_bytes = 512LL << 20;
  std::int64_t keep_unused_ms = 30LL * 24 * 3600 * 1000;  ///< 0: forever
  Quota quota = {};                                       ///< quota of each owner
};

/// Stores assets and uploads. An asset exists once its row exists, which is written after the bytes
/// are hashed and synced under their final name. Several owners may have uploaded the same asset
/// (asset_owners.h). Thread-safe.
class AssetStore {
 public:
  AssetStore(Database& database, const Layout& layout, const AssetStoreOptions& options,
             Clock clock);

  /// Returns the asset if its bytes are stored and the user may use them, and makes the user an
  /// owner. Otherwise starts an upload, or returns the one that the same request started.
  /// @return kResourceExhausted: ASSET_TOO_LARGE, DISK_FULL, UPLOADS_FULL, QUOTA_EXCEEDED;
  /// REQUEST_ID_REUSED
  [[nodiscard]] Result<AssetOrUpload> start(const Upload& wanted, const AssetUser& user,
                                            const RequestKey& request);
  /// Returns an upload of this owner; kNotFound, UPLOAD_NOT_FOUND if there is none.
  [[nodiscard]] Result<Upload> upload(const std::string& id, const std::string& owner);
  /// Returns the asset of any owner. Errors: kNotFound, ASSET_NOT_FOUND.
  [[nodiscard]] Result<Asset> asset(const std::string& sha256);
  /// Returns the asset, with the owners that the user may know. Also returns ASSET_NOT_FOUND if the
  /// user may not use it.
  [[nodiscard]] Result<Asset> asset_for(const std::string& sha256, const AssetUser& user);
  /// Returns kFailedPrecondition, ASSET_MISSING for inputs that the user may not use.
  [[nodiscard]] Status check_use(const std::vector<InputFile>& inputs, const AssetUser& user);
  /// Adds a complete, synced file with that hash as an asset without an owner, unless the asset
  /// exists. The file stays where it is but becomes read-only.
  /// @return kResourceExhausted, DISK_FULL
  [[nodiscard]] Result<Asset> adopt(const std::filesystem::path& file, const Asset& as);
  /// Returns the assets with hashes after `after`, sorted by hash, with their owners. Lists those
  /// of one owner, or all if `owner` is empty.
  [[nodiscard]] Result<std::vector<Asset>> list(const std::string& after, int limit,
                                                const std::string& owner);
  /// Deletes an asset. An operator deletes it for all users. Other users only stop owning it, which
  /// is possible if none of their jobs uses it; the asset is deleted once it has no owner and no
  /// job uses it.
  /// @return kFailedPrecondition, STATE_FORBIDS if a job uses it (for an operator: an unfinished
  ///         job); ASSET_NOT_FOUND
  [[nodiscard]] Status remove(const std::string& sha256, const AssetUser& user);
  /// Returns the current usage of an owner.
  [[nodiscard]] Result<Usage> usage(const std::string& owner) { return usage_of(database_, owner); }

  /// Deletes expired uploads and their files. Also deletes, oldest first and with a log entry each,
  /// assets that are not used by a job and have not been requested for too long.
  [[nodiscard]] Status purge();
  /// Repairs the store after a crash: adopts verified uploads without a row, sets aside files
  /// without a row, and logs rows without a file. Call this before serving clients.
  [[nodiscard]] Status sweep();

 private:
  [[nodiscard]] Status adopt_completed_uploads();
  [[nodiscard]] Status log_missing_files();
  /// Returns whether the asset's file exists with the right size.
  [[nodiscard]] bool has_file(const Asset& asset) const;
  friend class UploadWriter;
  [[nodiscard]] Status take(const Asset& asset, const std::string& owner);
  [[nodiscard]] Status insert(const Asset& asset);
  [[nodiscard]] Status delete_unused(const std::string& sha256);
  [[nodiscard]] Status purge_unused();
  [[nodiscard]] Result<Asset> complete(const Upload& upload);
  void give_up(const Upload& upload);
  void discard_unowned(const std::string& sha256);

  Database& database_;
  Layout layout_;
  AssetStoreOptions options_;
  Clock clock_;
  std::mutex busy_mutex_;
  std::set<std::string> busy_;  // uploads that have a writer
};

/// Writes the bytes of one call to an upload; at most one writer per upload at a time.
class UploadWriter {
 public:
  /// Errors: UPLOAD_NOT_FOUND; kAborted, UPLOAD_BUSY.
  [[nodiscard]] static Result<std::unique_ptr<UploadWriter>> open(AssetStore& store,
                                                                  const std::string& id,
                                                                  const std::string& owner);
  ~UploadWriter();
  UploadWriter(const UploadWriter&) = delete;
  UploadWriter& operator=(const UploadWriter&) = delete;

  /// Appends bytes. Errors: kOutOfRange: OFFSET_MISMATCH (metadata expected_offset),
  /// ASSET_TOO_LARGE. After kResourceExhausted, DISK_FULL the upload is deleted, so that it does
  /// not keep the disk full.
  [[nodiscard]] Status append(std::int64_t offset, std::string_view bytes);
  /// Syncs the received bytes to disk. If the upload is complete, verifies it and creates the
  /// asset.
  /// @return kInvalidArgument, ASSET_HASH_MISMATCH, or kResourceExhausted: DISK_FULL,
  /// QUOTA_EXCEEDED; the upload is then deleted
  [[nodiscard]] Result<AssetOrUpload> finish();

 private:
  UploadWriter(AssetStore& store, Upload upload) : store_(store), upload_(std::move(upload)) {}
  [[nodiscard]] Result<AssetOrUpload> verify();
  [[nodiscard]] Error give_up_if_full(Error error);  // also if the quota is exceeded

  AssetStore& store_;
  Upload upload_;
  UniqueFd file_;
};

}  // namespace hydroprint::daemon
