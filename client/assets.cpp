#include "client/assets.h"

#include <optional>
#include <utility>

#include "client/connection/rpc.h"
#include "client/uuid.h"

namespace hydroprint::client {
namespace {

using AssetStub = v1::AssetService::Stub;

std::string media_type(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  if (extension == ".png") return "image/png";
  if (extension == ".jpg" || extension == ".jpeg") return "image/jpeg";
  if (extension == ".tif" || extension == ".tiff") return "image/tiff";
  if (extension == ".obj") return "model/obj";
  if (extension == ".stl") return "model/stl";
  if (extension == ".ply") return "model/ply";
  if (extension == ".gltf") return "model/gltf+json";
  if (extension == ".glb") return "model/gltf-binary";
  return "application/octet-stream";
}

// Uploads one file, and reconnects when a call breaks.
class Uploader {
 public:
  Uploader(Connection& connection, const std::filesystem::path& path, const FileDigest& digest,
           const ByteProgress& progress)
      : connection_(connection), path_(path), digest_(digest), progress_(progress) {}

  Result<Uploaded> run() {
    HP_ASSIGN_OR_RETURN(auto known, start());
    if (known) return Uploaded{std::move(*known), true};
    for (int attempt = 0; attempt < kAttemptsWithoutProgress; ++attempt) {
      const std::int64_t before = received_;
      auto sent = send();
      if (sent && *sent) return Uploaded{std::move(**sent), false};
      if (!sent && sent.error().code != Code::kUnavailable && sent.error().code != Code::kAborted)
        return tl::unexpected(sent.error());
      last_ =
          sent ? Error{Code::kAborted, "the file shrank while it was uploaded; upload it again", {}}
               : sent.error();
      if (received_ > before) attempt = 0;
      pause(connection_, kTryAgainAfter);
      HP_ASSIGN_OR_RETURN(auto complete, find_out());
      if (complete) return Uploaded{std::move(*complete), false};
    }
    return tl::unexpected(last_);
  }

 private:
  // Returns the asset if the daemon already has the bytes; otherwise opens an upload.
  Result<std::optional<v1::Asset>> start() {
    v1::StartUploadRequest request;
    request.set_size_bytes(digest_.size_bytes);
    request.set_sha256(digest_.sha256);
    request.set_media_type(media_type(path_));
    request.set_request_id(make_uuid());
    HP_ASSIGN_OR_RETURN(const auto answer, call(connection_, *connection_.impl().assets,
                                                &AssetStub::StartUpload, request));
    if (answer.has_asset()) return std::optional(answer.asset());
    upload_ = answer.upload().name();
    received_ = answer.upload().received_bytes();
    return std::optional<v1::Asset>();
  }

  // Called after a lost connection: reads the resume offset, or returns the asset if the upload is
  // complete.
  Result<std::optional<v1::Asset>> find_out() {
    v1::GetUploadRequest request;
    request.set_name(upload_);
    const auto upload =
        call(connection_, *connection_.impl().assets, &AssetStub::GetUpload, request);
    if (upload) {
      received_ = upload->received_bytes();
      return std::optional<v1::Asset>();
    }
    if (upload.error().code == Code::kNotFound) return start();
    return tl::unexpected(upload.error());
  }

  // Makes one call; returns the asset if the call completed the upload.
  Result<std::optional<v1::Asset>> send() {
    Call call(connection_);
    v1::UploadChunkResponse answer;
    auto stream = connection_.impl().assets->UploadChunk(call.context(), &answer);
    const Status read = write_file(*stream);
    stream->WritesDone();
    const grpc::Status status = stream->Finish();
    if (!read) return tl::unexpected(read.error());
    if (!status.ok()) return tl::unexpected(to_error(connection_, status));
    if (answer.has_asset()) return std::optional(answer.asset());
    received_ = answer.upload().received_bytes();
    return std::optional<v1::Asset>();
  }

  Status write_file(grpc::ClientWriter<v1::UploadChunkRequest>& stream) {
    v1::UploadChunkRequest message;
    message.set_upload(upload_);
    message.set_offset(received_);
    if (digest_.size_bytes == received_) stream.Write(message);
    std::int64_t offset = received_;
    return read_file(path_, offset, [&](std::string_view bytes) {
      message.set_offset(offset);
      message.set_data(bytes.data(), bytes.size());
      if (!stream.Write(message)) return false;
      message.clear_upload();
      offset += static_cast<std::int64_t>(bytes.size());
      if (progress_) progress_(offset, digest_.size_bytes);
      return offset < digest_.size_bytes;
    });
  }

  Connection& connection_;
  const std::filesystem::path& path_;
  const FileDigest& digest_;
  const ByteProgress& progress_;
  std::string upload_;
  std::int64_t received_ = 0;
  Error last_;
};

Error about(const std::filesystem::path& path, Error error) {
  if (error.code == Code::kCancelled || error.code == Code::kUnavailable) return error;
  if (error.message.find(path.string()) == std::string::npos)
    error.message.insert(0, path.string() + ": ");
  return error;
}

}  // namespace

Result<Uploaded> upload_file(Connection& connection, const std::filesystem::path& path,
                             const ByteProgress& progress) {
  HP_ASSIGN_OR_RETURN(const FileDigest digest, digest_file(path, connection.options().stop));
  return Uploader(connection, path, digest, progress).run().map_error([&](Error error) {
    return about(path, std::move(error));
  });
}

Result<v1::ListAssetsResponse> list_assets(Connection& connection) {
  return all_pages(connection, *connection.impl().assets, &AssetStub::ListAssets,
                   v1::ListAssetsRequest(), &v1::ListAssetsResponse::assets_size);
}

Status delete_asset(Connection& connection, const std::string& name) {
  HP_RETURN_IF_ERROR(call(connection, *connection.impl().assets, &AssetStub::DeleteAsset,
                          named<v1::DeleteAssetRequest>(name)));
  return {};
}

}  // namespace hydroprint::client
