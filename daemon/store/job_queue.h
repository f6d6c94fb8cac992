#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/store/job_changes.h"

namespace hydroprint::daemon {

/// A queued job, as the scheduler sees it.
struct WaitingJob {
  std::int64_t id = 0;
  std::string owner;
  std::int32_t priority = 0;
  std::int64_t rank = 0;
};

/// Whether the queue is paused, and why.
struct QueuePause {
  bool paused = false;
  std::string reason;
};

/// The queue of computed jobs: their order, and whether the queue is paused. Errors as in
/// JobChanges. Thread-safe.
class JobQueue {
 public:
  explicit JobQueue(JobChanges& changes) : changes_(changes), database_(changes.database()) {}

  /// Returns all queued jobs. The jobs of one owner are in the order in which they will start.
  [[nodiscard]] Result<std::vector<WaitingJob>> waiting();
  /// Returns the computed jobs that are RUNNING, followed by those that are CANCELLING.
  [[nodiscard]] Result<std::vector<std::int64_t>> computing();
  /// Moves a queued job before another job of the same owner; if `before` is 0, to the end.
  [[nodiscard]] Result<Job> move(std::int64_t id, std::int64_t before);
  [[nodiscard]] Result<QueuePause> pause();
  [[nodiscard]] Status set_pause(const QueuePause& pause);

 private:
  JobChanges& changes_;
  Database& database_;
};

}  // namespace hydroprint::daemon
