#include "daemon/platform/durable_file.h"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <memory>
#include <vector>

#include "sim/base/sha256.h"

namespace hydroprint::daemon {
namespace {

struct CloseFolder {
  void operator()(DIR* folder) const { ::closedir(folder); }
};

UniqueFd open_folder_at(int parent, const char* name) {
  return UniqueFd(::openat(parent, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
}

/// Empties a folder. Folders in it are moved up to it before they are emptied in turn, so that each
/// needs one more descriptor at most, however deep they are.
class FolderClearing {
 public:
  explicit FolderClearing(const std::filesystem::path& path)
      : path_(path), top_(open_folder_at(AT_FDCWD, path.c_str())) {}

  void run() {
    if (!top_.valid()) return;
    clear(top_);
    while (!folders_.empty()) {
      const std::string name = std::move(folders_.back());
      folders_.pop_back();
      if (const UniqueFd folder = open_folder_at(top_.get(), name.c_str()); folder.valid()) {
        clear(folder);
      }
      ::unlinkat(top_.get(), name.c_str(), AT_REMOVEDIR);
    }
  }

 private:
  // Deletes the entries of a folder, except folders, which are then in folders_.
  void clear(const UniqueFd& folder) {
    (void)for_each_entry(folder, path_, [&](const std::string& name) -> Status {
      if (::unlinkat(folder.get(), name.c_str(), 0) == 0) return {};
      ::fchmodat(folder.get(), name.c_str(), 0700, AT_SYMLINK_NOFOLLOW);
      folders_.push_back(&folder == &top_ ? name : move_up(folder, name));
      return {};
    });
  }
  std::string move_up(const UniqueFd& folder, const std::string& name) {
    for (;;) {
      std::string free_name = fmt::format("discarded-{}", ++moved_);
      const int done = ::renameat(folder.get(), name.c_str(), top_.get(), free_name.c_str());
      const bool exists = done != 0 && (errno == EEXIST || errno == ENOTEMPTY || errno == ENOTDIR);
      if (!exists) return free_name;
    }
  }

  const std::filesystem::path& path_;
  UniqueFd top_;
  std::vector<std::string> folders_;  // in top_
  std::int64_t moved_ = 0;
};

}  // namespace

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

Status for_each_entry(const UniqueFd& folder, const std::filesystem::path& path,
                      const std::function<Status(const std::string& name)>& use) {
  UniqueFd own(open_folder_at(folder.get(), "."));  // with an offset of its own
  const std::unique_ptr<DIR, CloseFolder> entries(own.valid() ? ::fdopendir(own.get()) : nullptr);
  if (!entries) return system_failure(path, "cannot be read");
  (void)own.release();  // closed with the entries
  for (;;) {
    errno = 0;
    const dirent* const entry = ::readdir(entries.get());
    if (entry == nullptr) return errno == 0 ? Status() : system_failure(path, "cannot be read");
    const std::string name = entry->d_name;
    if (name != "." && name != "..") HP_RETURN_IF_ERROR(use(name));
  }
}

void discard(const std::filesystem::path& path) {
  if (::unlink(path.c_str()) == 0 || errno == ENOENT) return;
  ::fchmodat(AT_FDCWD, path.c_str(), 0700, AT_SYMLINK_NOFOLLOW);
  FolderClearing(path).run();
  ::rmdir(path.c_str());
}

Status read_blocks(const UniqueFd& file, const std::filesystem::path& path, std::int64_t bytes,
                   const std::function<Status(std::string_view block, std::int64_t offset)>& use) {
  constexpr std::int64_t kBlock = 1 << 20;
  std::string block(static_cast<std::size_t>(std::min(kBlock, bytes)), '\0');
  for (std::int64_t done = 0; done < bytes;) {
    const auto most = static_cast<std::size_t>(std::min(kBlock, bytes - done));
    const ssize_t count = ::pread(file.get(), block.data(), most, done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return system_failure(path, "its content cannot be read");
    if (count == 0) {
      return fail(Code::kInternal, path.string() + ": became shorter while it was read",
                  ErrorReason::STORE_FAILED);
    }
    HP_RETURN_IF_ERROR(use({block.data(), static_cast<std::size_t>(count)}, done));
    done += count;
  }
  return {};
}

Status copy_bytes(const UniqueFd& from, std::int64_t bytes, const std::filesystem::path& to,
                  const std::stop_token& stop) {
  HP_ASSIGN_OR_RETURN(const UniqueFd target, open_file(to, O_WRONLY | O_CREAT | O_EXCL));
  return read_blocks(from, to, bytes, [&](std::string_view block, std::int64_t offset) -> Status {
    if (stop.stop_requested()) return fail(Code::kCancelled, "cancelled");
    return write_at(target, to, block, offset);
  });
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

Result<std::string> sha256_of_file(const std::filesystem::path& path,
                                   const std::function<bool()>& is_cancelled) {
  HP_ASSIGN_OR_RETURN(const UniqueFd file, open_file(path, O_RDONLY));
  std::vector<char> buffer(128 << 10);
  Sha256 hash;
  for (;;) {
    const ssize_t count = ::read(file.get(), buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return system_failure(path, "cannot be read");
    if (count == 0) return hash.finish();
    if (is_cancelled && is_cancelled()) return fail(Code::kCancelled, "cancelled");
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
