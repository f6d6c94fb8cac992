#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "daemon/platform/clock.h"
#include "daemon/platform/notifier.h"
#include "daemon/store/database/database.h"
#include "daemon/store/job.h"

namespace hydroprint::daemon {

/// How long finished jobs are kept.
struct RetentionTimes {
  std::int64_t finished_ms = 30LL * 24 * 3600 * 1000;  ///< 0: for ever
  std::int64_t dips_ms = 365LL * 24 * 3600 * 1000;     ///< minimum for dips; 0: for ever
};

/// Changes the rows of jobs for JobStore, JobQueue, DeviceJobs and JobRetention. A change and its
/// event are one transaction, which is on disk when the call returns; the notifier then rings.
/// Thread-safe.
///
/// Computed jobs: QUEUED -> RUNNING -> SUCCEEDED | FAILED; QUEUED -> CANCELLED; RUNNING ->
/// CANCELLING -> CANCELLED; QUEUED -> SUCCEEDED from the cache. RUNNING -> INTERRUPTED -> QUEUED if
/// the daemon shut down, or daemon or worker was lost; the third loss leads to FAILED (DAEMON_LOST,
/// WORKER_KILLED).
/// Prints and captures start as RUNNING: RUNNING -> SUCCEEDED | FAILED | INTERRUPTED; RUNNING ->
/// CANCELLING -> CANCELLED.
/// Dips: WAITING_FOR_OPERATOR <-> RUNNING -> SUCCEEDED | FAILED. From either of these two states:
/// -> CANCELLING -> CANCELLED, or -> INTERRUPTED.
///
/// Methods of these classes that take a job's id return kNotFound, JOB_NOT_FOUND for an unknown
/// job; kFailedPrecondition, STATE_FORBIDS if its state does not allow the change; and the disk
/// errors of Database::run().
class JobChanges {
 public:
  JobChanges(Database& database, const RetentionTimes& times, Clock clock);

  /// Changes one job within a transaction, rings the notifier, and returns the changed job.
  [[nodiscard]] Result<Job> change(std::int64_t id, const std::function<Status(const Job&)>& body);
  /// Runs `body` as one transaction, then rings the notifier.
  [[nodiscard]] Status transaction(const std::function<Status()>& body);

  // Parts of a change; call these within a transaction.

  [[nodiscard]] Status add_event(std::int64_t id, EventKind kind, const std::string& message);
  [[nodiscard]] Status add_artifacts(std::int64_t id, const std::vector<Artifact>& artifacts);
  /// Stores a state that is not final.
  [[nodiscard]] Status set_state(std::int64_t id, JobState state, const std::string& message);
  /// Stores a final state and closes the execution; the job's retention starts.
  [[nodiscard]] Status finish(std::int64_t id, JobState state, const std::string& message);
  /// Stores FAILED with its reason.
  [[nodiscard]] Status finish_failed(std::int64_t id, const JobFailure& failure);
  /// Sets the deletion time of the finished jobs selected by `where`, an SQL condition with one `?`
  /// for `value`.
  [[nodiscard]] Status set_purge_time(const std::string& where, std::int64_t value);

  [[nodiscard]] Database& database() { return database_; }
  [[nodiscard]] std::int64_t now_ms() const { return clock_(); }
  /// Returns the notifier, which rings after every change.
  [[nodiscard]] Notifier& notifier() { return notifier_; }

 private:
  Database& database_;
  RetentionTimes times_;
  Clock clock_;
  Notifier notifier_;
};

}  // namespace hydroprint::daemon
