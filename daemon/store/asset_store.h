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

/// Verified bytes.
struct Asset {
  std::string sha256;
  std::int64_t size_bytes = 0;
  std::string media_type;
  std::int64_t create_ms = 0;
  std::vector<std::string> owners = {};  ///< by name
};

/// Bytes that are still to come.
struct Upload {
  std::string id;
  std::string sha256;
  std::int64_t size_bytes = 0;
  std::int64_t received_bytes = 0;
  std::string media_type;
  std::int64_t expire_ms = 0;
  std::string owner = {};
};

/// What an upload led to so far.
using AssetOrUpload = std::variant<Asset, Upload>;

/// Limits the store keeps.
struct AssetStoreOptions {
  std::int64_t max_bytes = 1LL << 30;
  std::int64_t max_open_uploads = 64;
  std::int64_t upload_expires_ms = 24LL * 3600 * 1000;
  std::int64_t min_free_bytes = 512LL << 20;
  std::int64_t keep_unused_ms = 30LL * 24 * 3600 * 1000;  ///< 0: for ever
  Quota quota = {};                                       ///< of each owner
};

/// Assets and uploads. An asset exists once its row does, which is written after its bytes were
/// hashed and are safe on disk under their final name. Whose it is, asset_owners.h says: several
/// may have uploaded the same. Any thread may call.
class AssetStore {
 public:
  AssetStore(Database& database, const Layout& layout, const AssetStoreOptions& options,
             Clock clock);

  /// The asset if the bytes are here and the user may use them (then it is theirs from now on,
  /// too), else an upload for them (the earlier one of the same request).
  /// @return kResourceExhausted: ASSET_TOO_LARGE, DISK_FULL, UPLOADS_FULL, QUOTA_EXCEEDED;
  ///   REQUEST_ID_REUSED
  [[nodiscard]] Result<AssetOrUpload> start(const Upload& wanted, const AssetUser& user,
                                            const RequestKey& request);
  /// kNotFound, UPLOAD_NOT_FOUND, if there is none of that owner's.
  [[nodiscard]] Result<Upload> upload(const std::string& id, const std::string& owner);
  /// Whosever it is. kNotFound, ASSET_NOT_FOUND.
  [[nodiscard]] Result<Asset> asset(const std::string& sha256);
  /// With the owners that the user may know of. ASSET_NOT_FOUND, too, if they may not use it.
  [[nodiscard]] Result<Asset> asset_for(const std::string& sha256, const AssetUser& user);
  /// Refuses (kFailedPrecondition, ASSET_MISSING) what the user may not use.
  [[nodiscard]] Status check_use(const std::vector<InputFile>& inputs, const AssetUser& user);
  /// Makes a file that is whole, safe on disk and has that hash an asset of nobody's, unless it is
  /// one already; the file stays, but can no longer be written.
  /// @return kResourceExhausted, DISK_FULL
  [[nodiscard]] Result<Asset> adopt(const std::filesystem::path& file, const Asset& as);
  /// In the order of their hashes, those after `after`, with their owners; of `owner` alone unless
  /// that is empty.
  [[nodiscard]] Result<std::vector<Asset>> list(const std::string& after, int limit,
                                                const std::string& owner);
  /// As an operator deletes it; as somebody else gives it up, if none of their own jobs was made of
  /// it, and deletes it if it is nobody's then and no job was made of it.
  /// @return kFailedPrecondition, STATE_FORBIDS: else, or while an unfinished job needs it;
  ///   ASSET_NOT_FOUND
  [[nodiscard]] Status remove(const std::string& sha256, const AssetUser& user);
  /// How much an owner has, and how much they may.
  [[nodiscard]] Result<Usage> usage(const std::string& owner) { return usage_of(database_, owner); }

  /// Deletes uploads whose time is up, files that belong to none, and, oldest first and logging
  /// each, assets that no job has been made of, and nobody asked for, for too long.
  [[nodiscard]] Status purge();
  /// After a crash, adopts verified uploads whose row is missing; sets aside files that have no
  /// row, and logs rows that have no file; only before anyone is served.
  [[nodiscard]] Status sweep();

 private:
  [[nodiscard]] Status adopt_completed_uploads();
  [[nodiscard]] Status log_missing_files();
  /// Whether its file is there, whole as far as its size tells.
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
  std::set<std::string> busy_;  // uploads that a writer has
};

/// One call's bytes on their way into an upload; at most one at a time for each.
class UploadWriter {
 public:
  /// UPLOAD_NOT_FOUND; kAborted, UPLOAD_BUSY.
  [[nodiscard]] static Result<std::unique_ptr<UploadWriter>> open(AssetStore& store,
                                                                  const std::string& id,
                                                                  const std::string& owner);
  ~UploadWriter();
  UploadWriter(const UploadWriter&) = delete;
  UploadWriter& operator=(const UploadWriter&) = delete;

  /// Appends bytes. kOutOfRange: OFFSET_MISMATCH (metadata expected_offset), ASSET_TOO_LARGE;
  /// kResourceExhausted, DISK_FULL: the upload is gone, so that it does not keep the disk full.
  [[nodiscard]] Status append(std::int64_t offset, std::string_view bytes);
  /// Makes what came safe on disk; with all bytes there, verifies them and makes the asset.
  /// @return kInvalidArgument, ASSET_HASH_MISMATCH, or kResourceExhausted: DISK_FULL,
  ///   QUOTA_EXCEEDED; the upload is gone
  [[nodiscard]] Result<AssetOrUpload> finish();

 private:
  UploadWriter(AssetStore& store, Upload upload) : store_(store), upload_(std::move(upload)) {}
  [[nodiscard]] Result<AssetOrUpload> verify();
  [[nodiscard]] Error give_up_if_full(Error error);  // or beyond the quota

  AssetStore& store_;
  Upload upload_;
  UniqueFd file_;
};

}  // namespace hydroprint::daemon
