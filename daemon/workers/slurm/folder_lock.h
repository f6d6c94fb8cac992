#pragma once

#include <filesystem>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::daemon::slurm {

/// The right of one daemon to hand over the jobs of an installation: the file `lock` in the
/// installation's folder, with host, process and a heartbeat, which is the time of its last change.
/// Times are compared by the clock of the folder's file system, because clocks of machines differ.
class FolderLock {
 public:
  /// Takes the lock, also from a daemon that ended without releasing it: from a process of this
  /// machine that does not exist any more, or if there was no heartbeat for 60 s.
  /// @return kFailedPrecondition if another daemon has it; kInternal, STORE_FAILED or
  ///         kResourceExhausted, DISK_FULL if the folder cannot be used
  [[nodiscard]] static Result<FolderLock> take(const std::filesystem::path& folder);
  /// Releases the lock.
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&&) = delete;

  /// Gives the heartbeat. To be called every few seconds.
  /// @return kFailedPrecondition if another daemon has taken the lock over; errors of the folder
  [[nodiscard]] Status beat() const;

 private:
  FolderLock(std::filesystem::path file, std::string words)
      : file_(std::move(file)), words_(std::move(words)) {}

  std::filesystem::path file_;  // empty: released
  std::string words_;           // the lock's content while it is ours
};

}  // namespace hydroprint::daemon::slurm
