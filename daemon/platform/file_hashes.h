#pragma once

#include <sys/stat.h>

#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "sim/base/result.h"

namespace hydroprint::daemon {

/// SHA-256 of files. Each file is read once, and again after its inode, size or ctime changed: any
/// change of its content, mode or number of links changes the ctime. The hash of a file that has
/// just changed is not kept, because a change within the same tick of the kernel's clock would not
/// be visible. Thread-safe.
class FileHashes {
 public:
  /// Returns the hash of a file's content, as sha256_of_file().
  [[nodiscard]] Result<std::string> of(const std::filesystem::path& path,
                                       const std::function<bool()>& is_cancelled = {});

 private:
  struct Entry {
    struct stat info {};
    std::string hash;
  };
  std::mutex mutex_;
  std::map<std::pair<dev_t, ino_t>, Entry> entries_;
};

}  // namespace hydroprint::daemon
