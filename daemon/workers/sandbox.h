#pragma once

#include <linux/filter.h>

#include <cstdint>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint::daemon {

/// What one worker may use up.
struct Limits {
  std::int64_t memory_bytes = 0;  ///< 0: no limit
  std::int64_t cpu_s = 0;         ///< processor time over all its threads
  std::int64_t file_bytes = 0;    ///< of one file it writes
};

/// What keeps a worker, which opens files from strangers, from doing harm: no network, no look at
/// other processes, no new privileges, no files but its own (see file_fence.h), limits on what it
/// uses up. Made once, before there are workers; confine() runs in the child.
class Sandbox {
 public:
  /// kFailedPrecondition if the machine's kernel or seccomp library cannot do it.
  [[nodiscard]] static Result<Sandbox> make();

  /// Confines the calling process for good. Between fork and exec: calls nothing that takes locks.
  /// @param fence  see make_fence(); below 0: none
  /// @return what failed, or nullptr
  [[nodiscard]] const char* confine(const Limits& limits, int fence) const;

  /// The least of it, for a program that opens nothing of strangers and needs a device: limits
  /// alone.
  [[nodiscard]] static const char* limit_use(const Limits& limits);

 private:
  std::vector<sock_filter> filter_;
};

}  // namespace hydroprint::daemon
