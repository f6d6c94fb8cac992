#include "client/artifacts.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "client/connection/rpc.h"
#include "client/files/files.h"

namespace hydroprint::client {
namespace {

using ArtifactStub = v1::ArtifactService::Stub;

tl::unexpected<Error> cannot_write(const std::filesystem::path& path, int error_number) {
  return fail(
      error_number == ENOSPC ? Code::kResourceExhausted : Code::kPermissionDenied,
      fmt::format(
          "{}: cannot be written ({}); choose another folder with --out, or free disk space",
          path.string(), std::strerror(error_number)));
}

// Appends bytes to the hidden file for an incomplete download.
class PartFile {
 public:
  explicit PartFile(std::filesystem::path path)
      : path_(std::move(path)),
        descriptor_(::open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644)) {}
  ~PartFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  Status is_open() const {
    if (descriptor_ < 0) return cannot_write(path_, errno);
    return {};
  }

  Status append(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return cannot_write(path_, errno);
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return {};
  }

  Status truncate() {
    if (::ftruncate(descriptor_, 0) != 0) return cannot_write(path_, errno);
    return {};
  }

  Status rename_to(const std::filesystem::path& path) {
    if (::fsync(descriptor_) != 0 || ::rename(path_.c_str(), path.c_str()) != 0)
      return cannot_write(path, errno);
    return {};
  }

 private:
  std::filesystem::path path_;
  int descriptor_;
};

// Downloads one artifact to a part file, and reconnects when a call breaks.
class Downloader {
 public:
  Downloader(Connection& connection, const v1::Artifact& artifact, PartFile& file,
             const ByteProgress& progress)
      : connection_(connection), artifact_(artifact), file_(file), progress_(progress) {}

  Status run(std::int64_t have_bytes) {
    done_ = have_bytes;
    for (int attempt = 0; attempt < kAttemptsWithoutProgress; ++attempt) {
      if (done_ == artifact_.size_bytes()) return {};
      const std::int64_t before = done_;
      Status received = receive();
      if (!received && received.error().code != Code::kUnavailable) return received;
      if (!received) last_ = received.error();
      if (done_ > before) attempt = 0;
      if (done_ != artifact_.size_bytes()) pause(connection_, kTryAgainAfter);
    }
    return tl::unexpected(last_);
  }

 private:
  Status receive() {
    Call call(connection_);
    v1::DownloadArtifactRequest request;
    request.set_name(artifact_.name());
    request.set_offset(done_);
    auto stream = connection_.impl().artifacts->DownloadArtifact(call.context(), request);
    v1::DownloadArtifactResponse piece;
    Status taken;
    while (taken && stream->Read(&piece)) taken = take(piece);
    if (!taken) call.context()->TryCancel();
    const grpc::Status status = stream->Finish();
    if (!taken) return taken;
    if (!status.ok()) return tl::unexpected(to_error(connection_, status));
    return {};
  }

  Status take(const v1::DownloadArtifactResponse& piece) {
    const auto size = static_cast<std::int64_t>(piece.data().size());
    if (piece.offset() != done_ || done_ + size > artifact_.size_bytes())
      return fail(Code::kDataLoss,
                  fmt::format("{}: byte {} arrived, but byte {} was expected; download it again",
                              artifact_.name(), piece.offset(), done_));
    HP_RETURN_IF_ERROR(file_.append(piece.data()));
    done_ += size;
    if (progress_) progress_(done_, artifact_.size_bytes());
    return {};
  }

  Connection& connection_;
  const v1::Artifact& artifact_;
  PartFile& file_;
  const ByteProgress& progress_;
  std::int64_t done_ = 0;
  Error last_{Code::kDataLoss, "the daemon sent no bytes; try again", {}};
};

bool has_digest(const std::filesystem::path& path, const std::string& sha256,
                const std::stop_token& stop) {
  const auto digest = digest_file(path, stop);
  return digest && digest->sha256 == sha256;
}

// Artifacts of two jobs may share a name, so the name of the part file includes the digest.
std::filesystem::path part_path(const std::filesystem::path& folder, const v1::Artifact& artifact) {
  std::string name = file_name(artifact);
  name.insert(0, 1, '.').append(".").append(artifact.sha256(), 0, 16).append(".part");
  return folder / name;
}

std::int64_t size_of(const std::filesystem::path& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  return error ? 0 : static_cast<std::int64_t>(size);
}

}  // namespace

std::string file_name(const v1::Artifact& artifact) {
  return std::filesystem::path(artifact.name()).filename().string();
}

Result<v1::ListArtifactsResponse> list_artifacts(Connection& connection, const std::string& job) {
  v1::ListArtifactsRequest request;
  request.set_parent(job);
  return all_pages(connection, *connection.impl().artifacts, &ArtifactStub::ListArtifacts, request,
                   &v1::ListArtifactsResponse::artifacts_size);
}

Result<std::filesystem::path> download(Connection& connection, const v1::Artifact& artifact,
                                       const std::filesystem::path& folder,
                                       const ByteProgress& progress) {
  std::filesystem::path path = folder / file_name(artifact);
  const std::stop_token& stop = connection.options().stop;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return cannot_write(folder, error.value());
  if (size_of(path) == artifact.size_bytes() && has_digest(path, artifact.sha256(), stop))
    return path;

  const std::filesystem::path part = part_path(folder, artifact);
  PartFile file(part);
  HP_RETURN_IF_ERROR(file.is_open());
  std::int64_t have_bytes = size_of(part);
  if (have_bytes > artifact.size_bytes()) {
    HP_RETURN_IF_ERROR(file.truncate());
    have_bytes = 0;
  }
  HP_RETURN_IF_ERROR(Downloader(connection, artifact, file, progress).run(have_bytes));
  if (!has_digest(part, artifact.sha256(), stop)) {
    if (stop.stop_requested()) return fail(Code::kCancelled, "interrupted");
    std::filesystem::remove(part, error);
    return fail(Code::kDataLoss,
                artifact.name() + ": SHA-256 does not match the bytes received; download it again");
  }
  HP_RETURN_IF_ERROR(file.rename_to(path));
  return path;
}

}  // namespace hydroprint::client
