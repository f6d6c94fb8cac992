#include "daemon/store/assets/upload_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

namespace hydroprint::daemon {

Result<std::unique_ptr<UploadWriter>> UploadWriter::open(Uploads& uploads, const std::string& id,
                                                         const std::string& owner) {
  HP_RETURN_IF_ERROR(uploads.claim(id));
  // From here on, the writer's destructor releases the upload.
  std::unique_ptr<UploadWriter> writer(new UploadWriter(uploads, id));
  HP_ASSIGN_OR_RETURN(writer->upload_, uploads.get(id, owner));
  HP_ASSIGN_OR_RETURN(writer->file_, open_file(uploads.file(id), O_WRONLY | O_CREAT));
  return writer;
}

UploadWriter::~UploadWriter() { uploads_.release(upload_.id); }

Status UploadWriter::append(std::int64_t offset, std::string_view bytes) {
  if (offset != upload_.received_bytes) {
    const std::int64_t expected = upload_.received_bytes;
    auto error = fail(
        Code::kOutOfRange,
        fmt::format("offset: {} is not the end of the upload; continue at {}", offset, expected),
        ErrorReason::OFFSET_MISMATCH);
    error.value().metadata["expected_offset"] = fmt::to_string(expected);
    return error;
  }
  const auto size = static_cast<std::int64_t>(bytes.size());
  if (size > upload_.size_bytes - offset)
    return asset_too_large(Code::kOutOfRange, upload_.size_bytes);
  const auto path = uploads_.file(upload_.id);
  const Status written = write_at(file_, path, bytes, offset);
  if (!written) return tl::unexpected(give_up_if_full(written.error()));
  upload_.received_bytes += size;
  return {};
}

Error UploadWriter::give_up_if_full(Error error) {
  if (error.reason == ErrorReason::DISK_FULL || error.reason == ErrorReason::QUOTA_EXCEEDED) {
    file_.reset();  // an open file would keep its space
    uploads_.give_up(upload_);
  }
  return error;
}

Result<AssetOrUpload> UploadWriter::finish() {
  return verify().map_error([&](Error error) { return give_up_if_full(std::move(error)); });
}

Result<AssetOrUpload> UploadWriter::verify() {
  const auto path = uploads_.file(upload_.id);
  if (::fsync(file_.get()) != 0) return system_failure(path, "cannot be flushed to disk");
  if (upload_.received_bytes < upload_.size_bytes) return AssetOrUpload(upload_);
  HP_ASSIGN_OR_RETURN(const std::string hash, sha256_of_file(path));
  if (hash == upload_.sha256) {
    HP_ASSIGN_OR_RETURN(Asset asset, uploads_.complete(upload_));
    return AssetOrUpload(std::move(asset));
  }
  uploads_.give_up(upload_);
  auto error =
      fail(Code::kInvalidArgument,
           fmt::format("the bytes have the hash {}, not the announced {}; start the upload again",
                       hash, upload_.sha256),
           ErrorReason::ASSET_HASH_MISMATCH);
  error.value().metadata["sha256"] = hash;
  return error;
}

}  // namespace hydroprint::daemon
