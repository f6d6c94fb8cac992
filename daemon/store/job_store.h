#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "daemon/platform/clock.h"
#include "daemon/platform/notifier.h"
#include "daemon/store/calibration.h"
#include "daemon/store/database/database.h"
#include "daemon/store/job.h"
#include "daemon/store/quota.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::daemon {

/// A queued job, as the scheduler sees it.
struct WaitingJob {
  std::int64_t id = 0;
  std::string owner;
  std::int32_t priority = 0;
  std::int64_t rank = 0;
};

/// Selects the jobs to list.
struct JobFilter {
  std::vector<JobState> states;  ///< empty: all
  std::string owner;             ///< empty: all
  std::int64_t before_id = 0;    ///< only older ones; 0: all
  int limit = 50;
};

/// Whether the queue is paused, and why.
struct QueuePause {
  bool paused = false;
  std::string reason;
};

/// Limits of the store.
struct JobStoreOptions {
  std::int64_t max_queued = 1000;
  std::int64_t keep_finished_ms = 30LL * 24 * 3600 * 1000;  ///< 0: forever
  std::int64_t keep_dips_ms = 365LL * 24 * 3600 * 1000;     ///< minimum for dips; 0: forever
  Quota quota = {};                                         ///< quota of each owner
};

/// Why running jobs are interrupted: the daemon shut down, or it was lost (it was killed, or the
/// machine crashed), in which case the next daemon finds them running.
enum class Interruption { kShutdown, kLoss };

/// Stores jobs, their events and the rows of their artifacts. Every change is one transaction with
/// its event, is on disk when the call returns, and is then notified. Thread-safe.
///
/// Computed jobs: QUEUED -> RUNNING -> SUCCEEDED | FAILED; QUEUED -> CANCELLED; RUNNING ->
/// CANCELLING -> CANCELLED; QUEUED -> SUCCEEDED from the cache. RUNNING -> INTERRUPTED -> QUEUED if
/// the daemon shut down or was lost; the third loss leads to FAILED (DAEMON_LOST).
/// Prints and captures: RUNNING immediately -> SUCCEEDED | FAILED, -> CANCELLING -> CANCELLED, ->
/// INTERRUPTED.
/// Dips: WAITING_FOR_OPERATOR <-> RUNNING -> SUCCEEDED | FAILED, both -> CANCELLING -> CANCELLED,
/// both -> INTERRUPTED.
///
/// Methods that name a job return kNotFound, JOB_NOT_FOUND if there is none, and
/// kFailedPrecondition, STATE_FORBIDS if its state does not allow the change. Disk errors are as in
/// Database::run().
class JobStore {
 public:
  JobStore(Database& database, const Layout& layout, const JobStoreOptions& options, Clock clock);

  /// Stores a job, or returns the one that the same request created. A computed job with the inputs
  /// of a successful one reuses its artifacts and is finished immediately. Jobs that are not
  /// computed are RUNNING, dips WAITING_FOR_OPERATOR.
  /// @return kResourceExhausted: QUEUE_FULL, QUOTA_EXCEEDED; kFailedPrecondition: ASSET_MISSING, or
  ///         STATE_FORBIDS for a job that is not computed while another of its kind is unfinished;
  ///         kInvalidArgument, REQUEST_ID_REUSED
  [[nodiscard]] Result<Job> create(const NewJob& made, const RequestKey& request);
  /// Returns the job that the same request created, if any. Errors: REQUEST_ID_REUSED;
  /// JOB_NOT_FOUND if it was deleted.
  [[nodiscard]] Result<std::optional<Job>> repeated(const std::string& owner,
                                                    const RequestKey& request);
  /// Returns ASSET_MISSING for inputs that are not stored.
  [[nodiscard]] Status check_inputs(const std::vector<InputFile>& inputs);

  [[nodiscard]] Result<Job> get(std::int64_t id);
  /// Lists jobs, newest first.
  [[nodiscard]] Result<std::vector<Job>> list(const JobFilter& filter);
  /// Deletes a finished job with all its data. Also returns STATE_FORBIDS while the calibration
  /// that it produced exists.
  [[nodiscard]] Status remove(std::int64_t id);
  /// Sets whether all users may see the job's artifacts.
  [[nodiscard]] Result<Job> share(std::int64_t id, bool shared);
  /// Pins or unpins a job; after unpinning, retention starts again from now.
  [[nodiscard]] Result<Job> pin(std::int64_t id, bool pinned);
  /// QUEUED -> CANCELLED, RUNNING or WAITING_FOR_OPERATOR -> CANCELLING; CANCELLING and CANCELLED
  /// do not change.
  [[nodiscard]] Result<Job> cancel(std::int64_t id);

  /// QUEUED -> RUNNING, or -> SUCCEEDED if an equal job has finished.
  [[nodiscard]] Result<Job> start(std::int64_t id);
  /// Stores the progress of a running job; ignored in other states.
  [[nodiscard]] Status report(std::int64_t id, const Progress& progress);
  /// RUNNING -> SUCCEEDED; CANCELLING -> CANCELLED.
  /// @param calibration  produced by the job, stored in the same transaction
  [[nodiscard]] Result<Job> succeed(std::int64_t id, const std::vector<Artifact>& artifacts,
                                    const std::optional<NewCalibration>& calibration = {});
  /// RUNNING -> FAILED, CANCELLING -> CANCELLED.
  [[nodiscard]] Result<Job> give_up(std::int64_t id, const JobFailure& failure);
  /// Updates an unfinished dip or print: its state (WAITING_FOR_OPERATOR or RUNNING), its
  /// `dip_status` (dips only) and its progress. Ignored for a job that is CANCELLING.
  [[nodiscard]] Status advance(std::int64_t id, JobState state, const std::string& dip_status,
                               const Progress& progress, const std::string& message);
  /// Ends a dip or print and stores its record: SUCCEEDED, FAILED (with the complete reason in
  /// `failure`), CANCELLED or INTERRUPTED.
  [[nodiscard]] Result<Job> end(std::int64_t id, JobState state,
                                const std::optional<JobFailure>& failure,
                                const std::string& dip_status, const std::vector<Artifact>& record,
                                const std::string& message);
  /// Returns unfinished dips: at most one, except after a crash.
  [[nodiscard]] Result<std::vector<std::int64_t>> open_dips();
  /// For all jobs: RUNNING -> INTERRUPTED -> QUEUED (or FAILED, see above), CANCELLING ->
  /// CANCELLED. The events contain the reason. Must only be called when no worker runs.
  [[nodiscard]] Status interrupt_all(Interruption why);

  /// Returns artifacts with names after `after`, sorted by name.
  [[nodiscard]] Result<std::vector<Artifact>> artifacts(std::int64_t id, const std::string& after,
                                                        int limit);
  /// Returns one artifact; kNotFound, ARTIFACT_NOT_FOUND.
  [[nodiscard]] Result<Artifact> artifact(std::int64_t id, const std::string& name);

  /// Returns the events of one job after `seq`, oldest first; kOutOfRange, EVENTS_GONE if event
  /// `seq` never existed.
  [[nodiscard]] Result<std::vector<JobEvent>> events(std::int64_t id, std::int64_t after_seq,
                                                     int limit);
  /// Same as events(), for all jobs.
  [[nodiscard]] Result<std::vector<JobEvent>> all_events(std::int64_t after_seq, int limit);
  /// Returns the number of the newest event; 0 if there was never one.
  [[nodiscard]] Result<std::int64_t> last_seq();

  /// Returns all queued jobs. The jobs of one owner are in the order in which they will start.
  [[nodiscard]] Result<std::vector<WaitingJob>> waiting();
  [[nodiscard]] Result<std::vector<std::int64_t>> ids_in_state(JobState state);
  /// Returns computed jobs that are RUNNING, followed by those that are CANCELLING.
  [[nodiscard]] Result<std::vector<std::int64_t>> computing();
  /// Moves a queued job before another of the same owner (0: to the end).
  [[nodiscard]] Result<Job> move(std::int64_t id, std::int64_t before);
  [[nodiscard]] Result<QueuePause> pause();
  [[nodiscard]] Status set_pause(const QueuePause& pause);

  /// Deletes finished jobs past their retention time, oldest first, and logs each. Keeps pinned
  /// jobs and jobs whose calibration exists. Deletes nothing while an open job reads artifacts,
  /// because these may belong to any job.
  [[nodiscard]] Status purge();
  /// Sets aside artifact folders without a job, empties the folder of runs, and applies the
  /// configured retention times. Call this before the pool starts.
  [[nodiscard]] Status sweep();

  [[nodiscard]] Notifier& notifier() { return notifier_; }

 private:
  [[nodiscard]] Result<std::int64_t> insert(const NewJob& made);
  [[nodiscard]] Status check_was_given(std::int64_t seq);
  [[nodiscard]] Status check_queue();
  [[nodiscard]] Status check_none_open(const std::string& verb);
  [[nodiscard]] Status store_dip_status(std::int64_t id, const std::string& dip_status);
  [[nodiscard]] Result<bool> adopt_cached(const Job& job);
  [[nodiscard]] Status set_purge_time(const std::string& where, std::int64_t value);
  [[nodiscard]] Status purge_one(std::int64_t id);
  void discard_unowned(std::int64_t id);
  [[nodiscard]] Status store_artifacts(std::int64_t id, const std::vector<Artifact>& artifacts);
  [[nodiscard]] Status change(std::int64_t id, JobState state, const std::string& message);
  [[nodiscard]] Status finish(std::int64_t id, JobState state, const std::string& message);
  [[nodiscard]] Status store_failure(std::int64_t id, const JobFailure& failure);
  [[nodiscard]] Status queue_again(std::int64_t id, Interruption why);
  [[nodiscard]] Status add_event(std::int64_t id, EventKind kind, const std::string& message);
  [[nodiscard]] Status change_running(JobState from, const std::function<Status(std::int64_t)>& to);
  [[nodiscard]] Result<Job> changed(std::int64_t id, const std::function<Status(const Job&)>& body);

  Database& database_;
  Layout layout_;
  JobStoreOptions options_;
  Clock clock_;
  Notifier notifier_;
};

}  // namespace hydroprint::daemon
