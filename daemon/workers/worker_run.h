#pragma once

#include <chrono>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "daemon/store/artifact_files.h"
#include "daemon/store/job_store.h"
#include "daemon/workers/child_process.h"
#include "daemon/workers/worker_outcome.h"

namespace hydroprint::daemon {

/// Runs one job in its worker, from the start of the process to the end of the job in the store.
/// Used by one thread (of the pool or of a capture), which it never blocks.
class WorkerRun {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Creates the input folder and starts the worker. `wake` is called from another thread when
  /// step() has something to do.
  static Result<std::unique_ptr<WorkerRun>> start(const Job& job, const Launch& launch,
                                                  const Layout& layout,
                                                  std::chrono::seconds time_limit,
                                                  std::function<void()> wake);
  ~WorkerRun();
  WorkerRun(const WorkerRun&) = delete;
  WorkerRun& operator=(const WorkerRun&) = delete;

  [[nodiscard]] std::int64_t job() const { return job_.id; }
  [[nodiscard]] const std::string& owner() const { return job_.definition.owner; }
  /// Returns descriptors that become readable when step() has something to do.
  [[nodiscard]] std::vector<int> descriptors() const;

  /// Reads output, checks limits and performs the next action. Returns true once the end of the job
  /// is stored, or the worker has ended after a stop for shutdown. A failed write is retried.
  [[nodiscard]] bool step(JobStore& store, std::int64_t now_ms);
  /// Requests the worker to end; it is killed after 3 s.
  void stop(StopReason why);

 private:
  /// The results of a successful worker.
  struct Outcome {
    std::vector<Artifact> artifacts;
    std::optional<NewCalibration> calibration;
  };

  WorkerRun(const Job& job, const Layout& layout) : job_(job), layout_(layout) {}
  void read_words();
  void read_progress_lines(JobStore& store, std::int64_t now_ms);
  void report(JobStore& store);
  void watch_limits();
  bool reap();
  [[nodiscard]] Result<Outcome> publish() const;
  void begin_publishing();
  bool finish(JobStore& store);
  [[nodiscard]] Result<Job> store_end(JobStore& store) const;
  void free_disk_for(const Error& error);
  void discard_output() const;
  void log_end(const Result<Job>& job) const;

  Job job_;
  Layout layout_;
  std::function<void()> wake_;
  ChildProcess worker_;
  std::int64_t memory_bytes_ = 0;
  Time deadline_;
  StopReason stopped_ = StopReason::kNothing;
  std::optional<Time> kill_at_;
  std::optional<int> wait_status_;
  std::string words_;                 // last bytes of the worker's stderr
  std::string answer_;                // last bytes of the worker's stdout
  std::string progress_bytes_;        // received bytes of an incomplete line
  std::optional<Progress> progress_;  // not yet reported
  Time next_report_, next_end_;
  std::future<Result<Outcome>> publishing_;
  std::optional<Result<Outcome>> published_;
};

}  // namespace hydroprint::daemon
