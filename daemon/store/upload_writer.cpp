// Writes the bytes of uploads.
#include <fcntl.h>
#include <unistd.h>

#include "daemon/store/asset_bytes.h"
#include "daemon/store/asset_store.h"

namespace hydroprint::daemon {

Result<std::unique_ptr<UploadWriter>> UploadWriter::open(AssetStore& store, const std::string& id,
                                                         const std::string& owner) {
  {
    const std::lock_guard lock(store.busy_mutex_);
    if (!store.busy_.insert(id).second) {
      return fail(Code::kAborted,
                  "uploads/" + id + ": another call is writing to this upload; wait for its end",
                  "UPLOAD_BUSY");
    }
  }
  // After this line, the writer's destructor releases the upload.
  std::unique_ptr<UploadWriter> writer(new UploadWriter(store, Upload{id, "", 0, 0, "", 0}));
  HP_ASSIGN_OR_RETURN(writer->upload_, store.upload(id, owner));
  HP_ASSIGN_OR_RETURN(writer->file_, open_file(store.layout_.upload(id), O_WRONLY | O_CREAT));
  return writer;
}

UploadWriter::~UploadWriter() {
  const std::lock_guard lock(store_.busy_mutex_);
  store_.busy_.erase(upload_.id);
}

Status UploadWriter::append(std::int64_t offset, std::string_view bytes) {
  if (offset != upload_.received_bytes) {
    const std::string expected = std::to_string(upload_.received_bytes);
    auto error = fail(Code::kOutOfRange,
                      "offset: " + std::to_string(offset) +
                          " is not the end of the upload; continue at " + expected,
                      "OFFSET_MISMATCH");
    error.value().metadata["expected_offset"] = expected;
    return error;
  }
  const auto size = static_cast<std::int64_t>(bytes.size());
  if (size > upload_.size_bytes - offset)
    return asset_too_large(Code::kOutOfRange, upload_.size_bytes);
  const auto path = store_.layout_.upload(upload_.id);
  const Status written = write_at(file_, path, bytes, offset);
  if (!written) return tl::unexpected(give_up_if_full(written.error()));
  upload_.received_bytes += size;
  return {};
}

Error UploadWriter::give_up_if_full(Error error) {
  if (error.reason == "DISK_FULL" || error.reason == "QUOTA_EXCEEDED") {
    file_.reset();  // an open file would keep its space
    store_.give_up(upload_);
  }
  return error;
}

Result<AssetOrUpload> UploadWriter::finish() {
  return verify().map_error([&](Error error) { return give_up_if_full(std::move(error)); });
}

Result<AssetOrUpload> UploadWriter::verify() {
  const auto path = store_.layout_.upload(upload_.id);
  if (::fsync(file_.get()) != 0) return system_failure(path, "cannot be flushed to disk");
  if (upload_.received_bytes < upload_.size_bytes) return AssetOrUpload(upload_);
  HP_ASSIGN_OR_RETURN(const std::string hash, sha256_of_file(path));
  if (hash == upload_.sha256) {
    HP_ASSIGN_OR_RETURN(Asset asset, store_.complete(upload_));
    return AssetOrUpload(std::move(asset));
  }
  HP_RETURN_IF_ERROR(store_.database_.run("DELETE FROM uploads WHERE id=?", {upload_.id}));
  discard(path);
  auto error = fail(Code::kInvalidArgument,
                    "the bytes have the hash " + hash + ", not the announced " + upload_.sha256 +
                        "; start the upload again",
                    "ASSET_HASH_MISMATCH");
  error.value().metadata["sha256"] = hash;
  return error;
}

}  // namespace hydroprint::daemon
