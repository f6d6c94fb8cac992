#pragma once

#include <cstdint>
#include <vector>

#include "daemon/store/job_changes.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::daemon {

/// Retention of finished jobs. Errors as in JobChanges. Thread-safe.
class JobRetention {
 public:
  JobRetention(JobChanges& changes, const Layout& layout)
      : changes_(changes), database_(changes.database()), layout_(layout) {}

  /// Pins or unpins a job; after unpinning, retention starts again from now.
  [[nodiscard]] Result<Job> pin(std::int64_t id, bool pinned);
  /// Deletes finished jobs past their retention time, oldest first, and logs each. Keeps pinned
  /// jobs and jobs whose calibration exists. Deletes nothing while an open job reads the artifacts
  /// of another job, since any job may be the other one.
  [[nodiscard]] Status purge();
  /// Sets aside artifact folders without a job, empties the folder of runs, and applies the
  /// configured retention times. Call this before the pool starts.
  /// @param kept  executions that are not lost; their folders and artifacts stay
  [[nodiscard]] Status sweep(const std::vector<Execution>& kept = {});

 private:
  [[nodiscard]] Status purge_one(std::int64_t id);
  [[nodiscard]] Status empty_runs(const std::vector<Execution>& kept);

  JobChanges& changes_;
  Database& database_;
  Layout layout_;
};

}  // namespace hydroprint::daemon
