#include "daemon/platform/durable_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <vector>

#include "sim/base/sha256.h"

namespace hydroprint::daemon {

UniqueFd& UniqueFd::operator=(UniqueFd&& other) noexcept {
  if (this != &other) {
    reset();
    fd_ = std::exchange(other.fd_, -1);
  }
  return *this;
}

void UniqueFd::reset() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

tl::unexpected<Error> system_failure(const std::filesystem::path& path, std::string_view what) {
  const int error = errno;
  const std::string text = fmt::format("{}: {}: ", path.string(), what);
  if (error == ENOSPC || error == EDQUOT) {
    return fail(Code::kResourceExhausted, text + "the disk is full; free disk space and try again",
                ErrorReason::DISK_FULL);
  }
  return fail(Code::kInternal,
              fmt::format("{}{}; check the permissions, the disk and the resource limits", text,
                          std::generic_category().message(error)),
              ErrorReason::STORE_FAILED);
}

Result<UniqueFd> open_file(const std::filesystem::path& path, int flags, unsigned mode) {
  UniqueFd file(::open(path.c_str(), flags | O_CLOEXEC | O_NOFOLLOW, mode));
  if (!file.valid()) return system_failure(path, "cannot be opened");
  return file;
}

Status write_at(const UniqueFd& file, const std::filesystem::path& path, std::string_view bytes,
                std::int64_t offset) {
  while (!bytes.empty()) {
    const ssize_t count = ::pwrite(file.get(), bytes.data(), bytes.size(), offset);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return system_failure(path, "cannot be written");
    bytes.remove_prefix(static_cast<std::size_t>(count));
    offset += count;
  }
  return {};
}

Status write_file(const std::filesystem::path& path, std::string_view bytes) {
  HP_ASSIGN_OR_RETURN(const UniqueFd file, open_file(path, O_WRONLY | O_CREAT | O_TRUNC));
  return write_at(file, path, bytes, 0);
}

Status sync_path(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(const UniqueFd file, open_file(path, O_RDONLY));
  if (::fsync(file.get()) != 0) return system_failure(path, "cannot be flushed to disk");
  return {};
}

Status publish(const std::filesystem::path& from, const std::filesystem::path& to) {
  if (::rename(from.c_str(), to.c_str()) != 0)
    return system_failure(to, "cannot be created by renaming a file");
  return sync_path(to.parent_path());
}

Status make_folder(const std::filesystem::path& path) {
  if (!path.parent_path().empty() && !std::filesystem::exists(path.parent_path())) {
    HP_RETURN_IF_ERROR(make_folder(path.parent_path()));
  }
  if (::mkdir(path.c_str(), 0700) == 0) {
    return path.has_parent_path() ? sync_path(path.parent_path()) : Status();
  }
  if (errno != EEXIST) return system_failure(path, "the folder cannot be created");
  std::error_code ignored;
  if (!std::filesystem::is_directory(path, ignored)) {
    errno = ENOTDIR;
    return system_failure(path, "is not a folder");
  }
  return {};
}

void discard(const std::filesystem::path& path) {
  std::error_code ignored;
  std::filesystem::remove_all(path, ignored);
}

Status copy_bytes(const UniqueFd& from, std::int64_t bytes, const std::filesystem::path& to,
                  const std::stop_token& stop) {
  constexpr std::int64_t kBlock = 1 << 20;
  HP_ASSIGN_OR_RETURN(const UniqueFd target, open_file(to, O_WRONLY | O_CREAT | O_EXCL));
  std::string block(kBlock, '\0');
  for (std::int64_t done = 0; done < bytes;) {
    if (stop.stop_requested()) return fail(Code::kCancelled, "cancelled");
    const auto most = static_cast<std::size_t>(std::min(kBlock, bytes - done));
    const ssize_t count = ::pread(from.get(), block.data(), most, done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return system_failure(to, "cannot be copied");
    if (count == 0) {
      return fail(Code::kInternal, to.string() + ": the original became shorter",
                  ErrorReason::STORE_FAILED);
    }
    const std::string_view piece(block.data(), static_cast<std::size_t>(count));
    HP_RETURN_IF_ERROR(write_at(target, to, piece, done));
    done += count;
  }
  return {};
}

Status link_or_copy(const std::filesystem::path& from, const std::filesystem::path& to,
                    const std::stop_token& stop) {
  if (::link(from.c_str(), to.c_str()) == 0) return {};
  if (errno == ENOENT || errno == EEXIST) return system_failure(from, "cannot be linked");
  HP_ASSIGN_OR_RETURN(const UniqueFd source, open_file(from, O_RDONLY));
  struct stat info {};
  if (::fstat(source.get(), &info) != 0) return system_failure(from, "cannot be read");
  return copy_bytes(source, info.st_size, to, stop);
}

Result<std::string> sha256_of_file(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(const UniqueFd file, open_file(path, O_RDONLY));
  std::vector<char> buffer(1 << 20);
  Sha256 hash;
  for (;;) {
    const ssize_t count = ::read(file.get(), buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return system_failure(path, "cannot be read");
    if (count == 0) return hash.finish();
    hash.add({buffer.data(), static_cast<std::size_t>(count)});
  }
}

Status check_free_space(const std::filesystem::path& path, std::int64_t bytes) {
  struct statvfs disk {};
  if (::statvfs(path.c_str(), &disk) != 0) return system_failure(path, "free space cannot be read");
  const auto free = static_cast<std::int64_t>(disk.f_bavail * disk.f_frsize);
  if (free >= bytes) return {};
  return fail(Code::kResourceExhausted,
              fmt::format("the daemon's disk is nearly full ({} MiB free, {} MiB needed); delete "
                          "jobs or assets, or free disk space",
                          free >> 20, bytes >> 20),
              ErrorReason::DISK_FULL);
}

}  // namespace hydroprint::daemon
