#include "daemon/platform/file_hashes.h"

#include <ctime>

#include "daemon/platform/durable_file.h"

namespace hydroprint::daemon {
namespace {

constexpr std::size_t kCapacity = 10'000;  // a few MiB

bool is_unchanged(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino && a.st_size == b.st_size &&
         a.st_ctim.tv_sec == b.st_ctim.tv_sec && a.st_ctim.tv_nsec == b.st_ctim.tv_nsec;
}

std::int64_t nanoseconds(const timespec& time) {
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

// Returns whether a change from now on gets another ctime: the kernel's clock for it has steps of
// up to 10 ms.
bool is_settled(const struct stat& info) {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  return nanoseconds(now) - nanoseconds(info.st_ctim) > 50'000'000;
}

}  // namespace

Result<std::string> FileHashes::of(const std::filesystem::path& path,
                                   const std::function<bool()>& is_cancelled) {
  struct stat before {};
  if (::lstat(path.c_str(), &before) != 0) return system_failure(path, "cannot be read");
  const bool may_be_kept = is_settled(before);
  const std::pair key(before.st_dev, before.st_ino);
  {
    const std::lock_guard lock(mutex_);
    const auto found = entries_.find(key);
    if (found != entries_.end() && is_unchanged(found->second.info, before)) {
      return found->second.hash;
    }
  }
  HP_ASSIGN_OR_RETURN(std::string hash, sha256_of_file(path, is_cancelled));
  struct stat after {};
  if (!may_be_kept || ::lstat(path.c_str(), &after) != 0 || !is_unchanged(before, after)) {
    return hash;
  }
  const std::lock_guard lock(mutex_);
  if (entries_.size() >= kCapacity) entries_.clear();
  entries_[key] = {before, hash};
  return hash;
}

}  // namespace hydroprint::daemon
