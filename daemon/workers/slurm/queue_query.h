#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <vector>

#include "daemon/workers/command_run.h"
#include "daemon/workers/slurm/queue.h"

namespace hydroprint::daemon::slurm {

/// Asks Slurm for all jobs, one query at a time, beside the caller.
class QueueQuery {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// A complete answer of Slurm.
  struct Answer {
    Queue queue;
    Time asked;  ///< when its query was started
  };

  /// @param folder    working directory of squeue
  /// @param between   least time from one query to the next
  /// @param patience  a query that takes longer is killed
  QueueQuery(std::filesystem::path folder, std::chrono::milliseconds between,
             std::chrono::milliseconds patience)
      : folder_(std::move(folder)), between_(between), patience_(patience) {}

  /// Takes the answer of the query that runs, or starts the next one if `is_wanted`. Does not wait.
  void step(bool is_wanted);
  /// Waits for the first answer, up to two seconds, once.
  void wait_once();
  /// Returns the last answer, if any.
  [[nodiscard]] const std::optional<Answer>& answer() const { return answer_; }
  /// Returns whether Slurm was asked after `since`, and answered.
  [[nodiscard]] bool is_answered_since(Time since) const {
    return answer_ && answer_->asked > since;
  }
  /// Returns the descriptors that become readable when step() has something to do.
  [[nodiscard]] std::vector<int> descriptors() const;

 private:
  void start();
  void take(const CommandEnd& end);

  std::filesystem::path folder_;
  std::chrono::milliseconds between_, patience_;
  Time next_, began_;
  bool has_waited_ = false;
  bool is_silent_ = false;
  std::optional<CommandRun> query_;
  std::optional<Answer> answer_;
};

}  // namespace hydroprint::daemon::slurm
