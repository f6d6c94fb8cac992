#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "daemon/store/artifact_files.h"
#include "daemon/store/job_store.h"
#include "daemon/workers/worker_executor.h"
#include "daemon/workers/worker_outcome.h"

namespace hydroprint::daemon {

/// How long the executor may know nothing about a worker before its job fails. The upgrade of an
/// engine, or the restart of its machine, takes less than an hour. After that, somebody has to look
/// at the engine, and the owner of the job has to learn it.
inline constexpr std::chrono::seconds kMostSilence{3600};

/// Limits of one worker.
struct RunLimits {
  std::chrono::seconds time;  ///< from its first sign of life; after an adoption, from the adoption
  std::chrono::milliseconds silence = kMostSilence;
  OutputLimits output = {};  ///< of its artifacts, and for publishing_time()
};

/// What a WorkerRun needs; must outlive it.
struct RunContext {
  WorkerExecutor& executor;
  const Layout& layout;
  RunLimits limits;
  /// Called from another thread when step() has something to do.
  std::function<void()> wake;
};

/// Follows one execution, from its start or adoption to the end of its job in the store: judges
/// what the executor reports. Used by one thread (of the pool or of a capture), which it never
/// blocks.
class WorkerRun {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Creates the input folder and starts the worker. If the folder is not on the disk of the state
  /// folder, a thread copies the inputs, and step() starts the worker when they are there.
  [[nodiscard]] static Result<std::unique_ptr<WorkerRun>> start(const Job& job, Execution execution,
                                                                const Launch& launch,
                                                                RunContext context);
  /// Continues an execution that an earlier daemon started. step() offers it to the executor, again
  /// each second until there is an answer.
  [[nodiscard]] static std::unique_ptr<WorkerRun> resume(const Job& job, const Execution& execution,
                                                         RunContext context);
  /// Deletes the folder of the run, unless the execution goes on.
  ~WorkerRun();
  WorkerRun(const WorkerRun&) = delete;
  WorkerRun& operator=(const WorkerRun&) = delete;

  [[nodiscard]] const std::string& owner() const { return job_.definition.owner; }
  [[nodiscard]] const Execution& execution() const { return execution_; }
  /// Returns whether step() needs an observation of the worker.
  [[nodiscard]] bool is_open() const { return phase_ == Phase::kOpen; }
  /// Returns whether the worker, if it runs, goes on when the daemon ends.
  [[nodiscard]] bool outlives_daemon() const;

  /// Judges what the executor observed (nullopt: no answer), checks limits and performs the next
  /// action. Returns true once the end of the job is stored, or the worker has ended after a stop
  /// for shutdown. A failed write is retried.
  [[nodiscard]] bool step(const std::optional<Observation>& seen, JobStore& store,
                          std::int64_t now_ms);
  /// Requests the worker to end; it is killed 3 s after the executor accepted the request. Once it
  /// has ended, requests the end of publishing.
  void stop(StopReason why);

 private:
  /// The results of a successful worker.
  struct Outcome {
    std::vector<Artifact> artifacts;
    std::optional<NewCalibration> calibration;
  };
  enum class Phase { kCopying, kOffered, kOpen, kEnded, kLost, kSilent };

  WorkerRun(const Job& job, Execution execution, RunContext context);
  [[nodiscard]] bool is_executors_own() const;
  [[nodiscard]] bool is_on_state_disk() const;
  [[nodiscard]] bool is_unended() const {
    return phase_ == Phase::kCopying || phase_ == Phase::kOffered || phase_ == Phase::kOpen;
  }
  void begin_copying();
  void await_inputs();
  [[nodiscard]] Status start_worker();
  void note_handle(JobStore& store);
  void watch(const std::optional<Observation>& seen, JobStore& store, std::int64_t now_ms);
  void offer_again();
  void judge_observation(const Observation& seen, std::int64_t now_ms);
  void take_progress(const std::vector<std::string>& lines, std::int64_t now_ms);
  void take_end(const WorkerEnds& end);
  void lose(Interruption why);
  void report(JobStore& store);
  void watch_limits();
  void ask_for_end();
  [[nodiscard]] std::filesystem::path output_copy() const;
  [[nodiscard]] Result<Outcome> publish(const PublishOptions& options) const;
  void begin_publishing();
  bool finish(JobStore& store);
  [[nodiscard]] Result<Job> store_end(JobStore& store) const;
  void free_disk_for(const Error& error);
  void discard_output() const;
  void log_end(const Result<Job>& job) const;

  Job job_;
  Execution execution_;
  RunContext context_;
  RunFolder folder_;
  Launch launch_;
  std::stop_source files_stop_;  // ends copying_ and publishing_
  std::future<Status> copying_;  // in Phase::kCopying
  Phase phase_ = Phase::kOpen;
  bool is_noted_ = true;  // the store knows the handle
  bool is_over_ = false;
  Time last_answer_, next_offer_;
  std::optional<Time> deadline_;  // set when the worker runs
  StopReason stopped_ = StopReason::kNothing;
  Time next_cancel_;
  std::optional<Time> kill_at_;  // set when the executor has been asked to end it gently
  WorkerEnds end_;               // in Phase::kEnded
  Interruption loss_ = Interruption::kWorkerLoss;  // in Phase::kLost
  std::string waiting_reason_;
  std::optional<Progress> progress_;  // not yet reported
  Time next_report_, next_end_;
  std::future<Result<Outcome>> publishing_;
  std::optional<Result<Outcome>> published_;
};

}  // namespace hydroprint::daemon
