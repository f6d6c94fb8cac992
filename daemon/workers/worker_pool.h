#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "daemon/jobs/executor.h"
#include "daemon/store/job_store.h"
#include "daemon/store/state_layout.h"
#include "sim/base/result.h"

namespace hydroprint::daemon {

/// How the pool runs workers.
struct PoolOptions {
  std::filesystem::path program;
  int slots = 1;                  ///< workers at once
  int cores = 1;                  ///< shared out among them where `threads` is 0
  int threads = 0;                ///< of each worker
  std::int64_t memory_bytes = 0;  ///< of each worker; 0: no limit
  std::int64_t time_limit_s = 3600;
  std::int64_t file_bytes = 4LL << 30;
};

/// Takes queued jobs from the store, runs a confined worker process for each, and brings what comes
/// of them back to the store. One thread starts and watches all workers (they die with it, so that
/// a killed daemon leaves none behind).
class WorkerPool final : public JobExecutor {
 public:
  /// @return kFailedPrecondition if workers cannot be confined or the program is not there
  [[nodiscard]] static Result<std::unique_ptr<WorkerPool>> make(const PoolOptions& options,
                                                                JobStore& store,
                                                                const Layout& layout, Clock clock);
  /// Stops if stop() was not called.
  ~WorkerPool() override;

  void start();
  /// Refuses (ASSET_MISSING) inputs that are not here; WORKER_UNUSABLE.
  [[nodiscard]] Result<Job> check(const JobRequest& request) override;
  /// Stores a job, which waits for its turn.
  [[nodiscard]] Result<Job> create(const JobRequest& request) override;
  [[nodiscard]] Result<Job> cancel(std::int64_t job) override;
  /// Ends the workers and waits for that, a few seconds at most. Their jobs stay RUNNING or
  /// CANCELLING in the store: see JobStore::interrupt_all().
  void stop() override;
  /// Has it look at the store at once (a new job, a cancel).
  void wake();

  /// Queued jobs in the order in which they will start if nothing changes; at most `limit`.
  [[nodiscard]] Result<std::vector<std::int64_t>> order(std::size_t limit) const;
  [[nodiscard]] int slots() const;

 private:
  WorkerPool();
  [[nodiscard]] Result<NewJob> with_digest(const JobRequest& request) const;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::daemon
