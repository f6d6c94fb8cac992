#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "daemon/workers/worker_executor.h"

namespace hydroprint::daemon {

/// An executor whose workers are processes of their own session, which go on when the daemon ends.
/// The folder of an execution holds its state: `lock` is locked while anything of it lives, `begin`
/// has the worker's process id, `exit` its status.
///
/// In the folder `records`: each start of a worker adds the line "JOB ATTEMPT" to `starts`, and
/// each call of adopt() the same line to `offers`. While there is a file `mute`, no call is
/// answered.
class DetachedExecutor final : public WorkerExecutor {
 public:
  DetachedExecutor(std::filesystem::path records, int capacity)
      : records_(std::move(records)), capacity_(capacity) {}

  [[nodiscard]] std::string name() const override { return "detached"; }
  [[nodiscard]] bool outlives_daemon() const override { return true; }
  [[nodiscard]] int capacity() const override { return capacity_; }
  /// The handle is the process id of the session's leader.
  [[nodiscard]] Result<std::string> start(const Execution& execution,
                                          const Launch& launch) override;
  [[nodiscard]] Observations poll(const std::vector<Execution>& executions) override;
  [[nodiscard]] Status cancel(const Execution& execution, CancelHow how) override;
  [[nodiscard]] Adoption adopt(const Execution& execution) override;

 private:
  [[nodiscard]] bool is_mute() const { return std::filesystem::exists(records_ / "mute"); }
  [[nodiscard]] Observation observe(const Execution& execution);
  [[nodiscard]] std::vector<std::string> new_progress(const Execution& execution);

  std::filesystem::path records_;
  int capacity_;
  std::map<std::int64_t, std::string> progress_;  // seen so far, by job
};

/// Whether a process of the execution lives.
[[nodiscard]] bool lives(const std::filesystem::path& folder);

}  // namespace hydroprint::daemon
