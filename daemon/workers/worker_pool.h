#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "daemon/jobs/executor.h"
#include "daemon/store/job_queue.h"
#include "daemon/store/job_store.h"
#include "daemon/store/state_layout.h"
#include "sim/base/result.h"

namespace hydroprint::daemon {

/// Settings for running workers.
struct PoolOptions {
  std::filesystem::path program;
  std::filesystem::path confine_program;  ///< hydroprint-confine
  int slots = 1;                          ///< maximum number of workers
  int cores = 1;    ///< number of processor cores, divided among workers if `threads` is 0
  int threads = 0;  ///< number of threads per worker; 0: a share of the cores
  std::int64_t memory_bytes = 0;  ///< limit per worker; 0: no limit
  std::int64_t time_limit_s = 3600;
  std::int64_t file_bytes = 4LL << 30;
};

/// Executes queued jobs from the store: runs a confined worker process for each, and stores the
/// results. One thread starts and monitors all workers. They are killed when that thread ends, so
/// no worker survives a killed daemon.
class WorkerPool final : public JobExecutor {
 public:
  /// @return kFailedPrecondition if workers cannot be confined; kInternal, WORKER_UNUSABLE if the
  /// program does not exist
  [[nodiscard]] static Result<std::unique_ptr<WorkerPool>> make(const PoolOptions& options,
                                                                JobStore& store, JobQueue& queue,
                                                                const Layout& layout, Clock clock);
  /// Calls stop() if needed.
  ~WorkerPool() override;

  void start();
  /// Errors: ASSET_MISSING for missing inputs; WORKER_UNUSABLE.
  [[nodiscard]] Result<Job> check(const JobRequest& request) override;
  /// Stores and queues a job.
  [[nodiscard]] Result<Job> create(const JobRequest& request) override;
  [[nodiscard]] Result<Job> cancel(std::int64_t job) override;
  /// Ends the workers and waits a few seconds at most. Their jobs stay RUNNING or CANCELLING in the
  /// store: see JobStore::interrupt_all().
  void stop() override;
  /// Makes the pool check the store immediately, for example for a new job or a cancellation.
  void wake();

  /// Returns the ids of queued jobs in the order in which they would start now; at most `limit`.
  [[nodiscard]] Result<std::vector<std::int64_t>> order(std::size_t limit) const;
  [[nodiscard]] int slots() const;

 private:
  WorkerPool();
  [[nodiscard]] Result<NewJob> with_digest(const JobRequest& request) const;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::daemon
