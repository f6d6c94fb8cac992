#include "sim/base/artifact_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

namespace hydroprint::image {
namespace {

tl::unexpected<Error> system_failure(const std::filesystem::path& path, int error) {
  const std::string start = path.string() + ": ";
  switch (error) {
    case ENOSPC:
    case EDQUOT:
      return fail(Code::kResourceExhausted,
                  start + "the disk is full. Free some space or choose another folder",
                  ErrorReason::DISK_FULL);
    case EFBIG:
      return fail(Code::kResourceExhausted,
                  start + "larger than the limit on file sizes. Raise the limit (ulimit -f)",
                  ErrorReason::OUTPUT_LIMIT);
    case ENOENT:
    case ENOTDIR:
      return fail(Code::kNotFound,
                  start + "its folder does not exist. Create the folder or choose another");
    case EACCES:
    case EPERM:
    case EROFS:
      return fail(Code::kPermissionDenied,
                  start + "not writable. Choose a folder that you may write to");
    default:
      return fail(Code::kInternal, fmt::format("{}writing failed ({}). Check the disk and the path",
                                               start, std::strerror(error)));
  }
}

/// @return 0 on success, otherwise errno
int write_all(int file, std::span<const unsigned char> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    if (written == 0) return ENOSPC;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return ::fsync(file) == 0 || errno == EINVAL ? 0 : errno;
}

}  // namespace

Status write_artifact(const std::filesystem::path& path, std::span<const unsigned char> bytes) {
  const std::string temporary = fmt::format("{}.part-{}", path.string(), ::getpid());
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) return system_failure(path, errno);
  int error = write_all(file, bytes);
  if (::close(file) != 0 && error == 0) error = errno;
  if (error == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error == 0) return {};
  ::unlink(temporary.c_str());
  return system_failure(path, error);
}

Status write_artifact(const std::filesystem::path& path, std::string_view text) {
  return write_artifact(
      path, std::span(reinterpret_cast<const unsigned char*>(text.data()), text.size()));
}

}  // namespace hydroprint::image
