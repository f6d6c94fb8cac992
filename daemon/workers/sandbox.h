#pragma once

#include <linux/filter.h>

#include <cstdint>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint::daemon {

/// Resource limits of one worker.
struct Limits {
  std::int64_t memory_bytes = 0;  ///< 0: no limit
  std::int64_t cpu_s = 0;         ///< processor time, summed over all threads
  std::int64_t file_bytes = 0;    ///< maximum size of each file that the worker writes
};

/// Confines a worker, because it reads untrusted files: no network, no access to other processes,
/// no new privileges, no files except its own (landlock.h), and resource limits. Create it once,
/// before starting workers; confine() runs in the child.
class Sandbox {
 public:
  /// Returns kFailedPrecondition if the kernel or the seccomp library cannot filter system calls.
  [[nodiscard]] static Result<Sandbox> make();

  /// Confines the calling process permanently. Runs between fork and exec, so it acquires no locks.
  /// @param ruleset  see make_ruleset(); negative: none
  /// @return the step that failed, or nullptr
  [[nodiscard]] const char* confine(const Limits& limits, int ruleset) const;

  /// Sets only the resource limits, for a program that reads no untrusted files and needs a device.
  [[nodiscard]] static const char* limit_use(const Limits& limits);

 private:
  std::vector<sock_filter> filter_;
};

}  // namespace hydroprint::daemon
