#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "daemon/platform/durable_file.h"
#include "daemon/store/assets/uploads.h"

namespace hydroprint::daemon {

/// Writes the bytes of one call to an upload; at most one writer per upload at a time.
class UploadWriter {
 public:
  /// Opens an upload of this owner for writing. Errors: kNotFound, UPLOAD_NOT_FOUND; kAborted,
  /// UPLOAD_BUSY.
  [[nodiscard]] static Result<std::unique_ptr<UploadWriter>> open(Uploads& uploads,
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
  UploadWriter(Uploads& uploads, const std::string& id) : uploads_(uploads) { upload_.id = id; }
  [[nodiscard]] Result<AssetOrUpload> verify();
  [[nodiscard]] Error give_up_if_full(Error error);  // also if the quota is exceeded

  Uploads& uploads_;
  Upload upload_;
  UniqueFd file_;
};

}  // namespace hydroprint::daemon
