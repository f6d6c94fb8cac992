#pragma once

#include <cstdint>

#include "daemon/confine/landlock.h"

namespace hydroprint::confine {

/// Limits of one worker; 0: no limit.
struct Limits {
  std::int64_t memory_bytes = 0;
  std::int64_t cpu_s = 0;       ///< processor time, summed over all threads
  std::int64_t file_bytes = 0;  ///< maximum size of each file that the worker writes
  /// false: also runs on a kernel without Landlock, with access to every file of its user.
  bool needs_landlock = true;
};

/// Confines the calling process permanently, because it will read untrusted files: no network, no
/// other processes (call_filter.h), no new privileges, no files except its own (landlock.h), and
/// resource limits. It may signal its own threads, also after exec. The process must have one
/// thread.
/// @return the step that failed, with the reason in errno; nullptr if it is confined
[[nodiscard]] const char* confine(const Limits& limits, const Files& files);

/// Sets only the resource limits, for a program that reads no untrusted files and needs a device.
/// May run between fork and exec, because it acquires no locks.
/// @return as confine()
[[nodiscard]] const char* limit_use(const Limits& limits);

/// Ends a process that cannot become a worker: writes "the worker cannot be started: STEP: REASON"
/// to stderr, with the reason from errno, and exits with status 127. Acquires no locks.
[[noreturn]] void give_up(const char* step);

}  // namespace hydroprint::confine
