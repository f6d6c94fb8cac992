#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "daemon/store/job.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::daemon {

/// A job requested by a client, checked and with all references resolved.
struct JobRequest {
  NewJob definition;
  v1::Job job;  ///< with the spec that users see; serialised in `definition.body`
  RequestKey key;
  std::string lease_id;
};

/// Executes jobs of some kinds. Thread-safe.
class JobExecutor {
 public:
  virtual ~JobExecutor() = default;
  JobExecutor(const JobExecutor&) = delete;
  JobExecutor& operator=(const JobExecutor&) = delete;

  /// Performs the checks of create(), except those of the store's limits.
  /// @return the job in its initial state, without a name
  [[nodiscard]] virtual Result<Job> check(const JobRequest& request) = 0;
  /// Stores a job and starts or queues it. A repeated request returns the job that the first
  /// request created.
  [[nodiscard]] virtual Result<Job> create(const JobRequest& request) = 0;
  /// Cancels a job, whether or not it is running.
  [[nodiscard]] virtual Result<Job> cancel(std::int64_t job) = 0;
  /// Ends running jobs for a shutdown and rejects new ones. JobStore::interrupt_all() ends the jobs
  /// that remain open.
  virtual void stop() = 0;

 protected:
  JobExecutor() = default;
};

/// The executors, in the order in which they are stopped: dips first, so that the axis comes to
/// rest.
enum class ExecutorId : std::uint8_t { kDips, kPrints, kCaptures, kWorkers };

/// One executor for each id.
class Executors {
 public:
  Executors(JobExecutor& dips, JobExecutor& prints, JobExecutor& captures, JobExecutor& workers)
      : all_{&dips, &prints, &captures, &workers} {}

  [[nodiscard]] JobExecutor& operator[](ExecutorId id) const {
    return *all_.at(static_cast<std::size_t>(id));
  }
  [[nodiscard]] auto begin() const { return all_.begin(); }
  [[nodiscard]] auto end() const { return all_.end(); }

 private:
  std::array<JobExecutor*, 4> all_;
};

}  // namespace hydroprint::daemon
