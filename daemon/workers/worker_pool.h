#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "daemon/jobs/executor.h"
#include "daemon/store/job_queue.h"
#include "daemon/store/job_store.h"
#include "daemon/store/state_layout.h"
#include "daemon/workers/worker_executor.h"
#include "daemon/workers/worker_launch.h"
#include "daemon/workers/worker_run.h"
#include "sim/base/result.h"

namespace hydroprint::daemon {

/// Executes queued jobs from the store: runs a worker for each at a WorkerExecutor, and stores the
/// results. One thread starts and monitors all workers. Executions that are open in the store when
/// it starts are offered to the executor, and go on if it adopts them.
class WorkerPool final : public JobExecutor {
 public:
  /// @param executor  must outlive the pool, whose thread is its only user
  /// @param silence   see RunLimits
  /// @return kInternal, WORKER_UNUSABLE if the program does not exist
  [[nodiscard]] static Result<std::unique_ptr<WorkerPool>> make(
      const PoolOptions& options, WorkerExecutor& executor, JobStore& store, JobQueue& queue,
      const Layout& layout, Clock clock, std::chrono::milliseconds silence = kMostSilence);
  /// Calls stop() if needed.
  ~WorkerPool() override;

  void start();
  /// Errors: ASSET_MISSING for missing inputs; WORKER_UNUSABLE.
  [[nodiscard]] Result<Job> check(const JobRequest& request) override;
  /// Stores and queues a job.
  [[nodiscard]] Result<Job> create(const JobRequest& request) override;
  [[nodiscard]] Result<Job> cancel(std::int64_t job) override;
  /// Ends the workers and waits a few seconds at most; those that outlive the daemon go on. The
  /// jobs stay RUNNING or CANCELLING in the store: see surviving() and JobStore::interrupt_all().
  void stop() override;
  /// Makes the pool check the store immediately, for example for a new job or a cancellation.
  void wake();

  /// Returns the ids of queued jobs in the order in which they would start now; at most `limit`.
  [[nodiscard]] Result<std::vector<std::int64_t>> order(std::size_t limit) const;
  [[nodiscard]] int slots() const;
  /// Returns why the executor takes no jobs now (WorkerExecutor::ready()); empty if it takes them.
  [[nodiscard]] std::string blocked_reason() const;
  [[nodiscard]] const PoolOptions& options() const;

 private:
  WorkerPool();
  [[nodiscard]] Result<NewJob> with_digest(const JobRequest& request) const;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::daemon
