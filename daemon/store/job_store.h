#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "daemon/platform/file_hashes.h"
#include "daemon/store/calibration.h"
#include "daemon/store/interruption.h"
#include "daemon/store/job.h"
#include "daemon/store/job_changes.h"
#include "daemon/store/job_rows.h"
#include "daemon/store/quota.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::daemon {

/// Selects the jobs to list.
struct JobFilter {
  std::vector<JobState> states;  ///< empty: all
  std::string owner;             ///< empty: all
  std::int64_t before_id = 0;    ///< only jobs older than this one; 0: all
  int limit = 50;
};

/// Limits of the store.
struct JobStoreOptions {
  std::int64_t max_queued = 1000;
  Quota quota = {};  ///< for each owner
};

/// Stores jobs, their events and the rows of their artifacts. A change and its event are one
/// transaction, which is on disk when the call returns; the notifier then rings. Thread-safe.
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
/// Methods that take a job's id return kNotFound, JOB_NOT_FOUND for an unknown job, and
/// kFailedPrecondition, STATE_FORBIDS if its state does not allow the change. Disk errors are as in
/// Database::run().
class JobStore {
 public:
  JobStore(JobChanges& changes, const Layout& layout, const JobStoreOptions& options);

  /// Stores a job, or returns the one that an earlier request with the same id created. A computed
  /// job with the same inputs as a successful job reuses its artifacts and is finished immediately.
  /// Jobs that are not computed start as RUNNING, dips as WAITING_FOR_OPERATOR.
  /// @return kResourceExhausted: QUEUE_FULL, QUOTA_EXCEEDED; kFailedPrecondition: ASSET_MISSING, or
  ///         STATE_FORBIDS for a job that is not computed while another of its kind is unfinished;
  ///         kInvalidArgument, REQUEST_ID_REUSED
  [[nodiscard]] Result<Job> create(const NewJob& definition, const RequestKey& request);
  /// Returns the job that an earlier request with the same id created, if any. Errors:
  /// REQUEST_ID_REUSED; JOB_NOT_FOUND if it was deleted.
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
  /// Cancels a job: QUEUED -> CANCELLED; RUNNING or WAITING_FOR_OPERATOR -> CANCELLING. Does
  /// nothing if the job is CANCELLING or CANCELLED.
  [[nodiscard]] Result<Job> cancel(std::int64_t id);

  /// Starts a queued job: QUEUED -> RUNNING, or -> SUCCEEDED if the artifacts of a job with the
  /// same inputs can be reused. RUNNING begins a new attempt.
  /// @param executor  name of the executor that will run the attempt; its execution is stored as
  ///                  open. Empty: none is stored.
  /// @param runs      where the folder of the execution will be; empty: in the state folder
  [[nodiscard]] Result<Job> start(std::int64_t id, const std::string& executor = "",
                                  const std::filesystem::path& runs = {});
  /// Returns the open executions of all jobs.
  [[nodiscard]] Result<std::vector<Execution>> executions() { return select_executions(database_); }
  /// Stores the handle of an open execution.
  [[nodiscard]] Status note_handle(const Execution& execution) {
    return store_handle(database_, execution);
  }
  /// Stores the progress of a running job; ignored in other states.
  [[nodiscard]] Status report(std::int64_t id, const Progress& progress);
  /// Ends a job that succeeded: RUNNING -> SUCCEEDED; CANCELLING -> CANCELLED.
  /// @param calibration  produced by the job, stored in the same transaction
  [[nodiscard]] Result<Job> succeed(std::int64_t id, const std::vector<Artifact>& artifacts,
                                    const std::optional<NewCalibration>& calibration = {});
  /// Ends a job that failed: RUNNING -> FAILED; CANCELLING -> CANCELLED.
  [[nodiscard]] Result<Job> give_up(std::int64_t id, const JobFailure& failure);
  /// Interrupts all open jobs. Computed jobs: RUNNING -> INTERRUPTED -> QUEUED (or FAILED, see
  /// JobChanges). Other jobs: RUNNING or WAITING_FOR_OPERATOR -> INTERRUPTED. All: CANCELLING ->
  /// CANCELLED. The events contain the reason. Call this only when no worker runs, except in
  /// `kept`.
  /// @param kept  executions that go on; their jobs stay as they are
  [[nodiscard]] Status interrupt_all(Interruption why, const std::vector<Execution>& kept = {});
  /// Interrupts one computed job that is RUNNING or CANCELLING, in the same way.
  [[nodiscard]] Result<Job> interrupt(std::int64_t id, Interruption why);

  /// Returns artifacts with names after `after`, sorted by name.
  [[nodiscard]] Result<std::vector<Artifact>> artifacts(std::int64_t id, const std::string& after,
                                                        int limit);
  /// Returns one artifact; kNotFound, ARTIFACT_NOT_FOUND if the job has none with that name.
  [[nodiscard]] Result<Artifact> artifact(std::int64_t id, const std::string& name);
  /// Returns one artifact if its file has the stored size and hash. Reads the whole file, unless it
  /// was read since it last changed.
  /// @param is_cancelled  ends the reading if it returns true
  /// @return kDataLoss, ARTIFACT_DAMAGED; kCancelled; errors of artifact()
  [[nodiscard]] Result<Artifact> sound_artifact(std::int64_t id, const std::string& name,
                                                const std::function<bool()>& is_cancelled = {});

  /// Returns the events of one job after `seq`, oldest first; kOutOfRange, EVENTS_GONE if event
  /// `seq` never existed.
  [[nodiscard]] Result<std::vector<JobEvent>> events(std::int64_t id, std::int64_t after_seq,
                                                     int limit);
  /// Same as events(), for all jobs.
  [[nodiscard]] Result<std::vector<JobEvent>> all_events(std::int64_t after_seq, int limit);
  /// Returns the number of the newest event; 0 if there was never one.
  [[nodiscard]] Result<std::int64_t> last_seq();

  [[nodiscard]] Result<std::vector<std::int64_t>> ids_in_state(JobState state);
  /// Returns the notifier, which rings after every change of any job.
  [[nodiscard]] Notifier& notifier() { return changes_.notifier(); }

 private:
  /// A finished job with the same inputs, and its artifacts; id 0: there is none.
  struct EqualJob {
    std::int64_t id = 0;
    std::vector<Artifact> files;
  };

  [[nodiscard]] Result<std::int64_t> insert(const NewJob& definition);
  [[nodiscard]] Status check_was_given(std::int64_t seq);
  [[nodiscard]] Status check_queue();
  [[nodiscard]] Result<EqualJob> find_equal(const NewJob& definition);
  [[nodiscard]] Result<bool> adopt_cached(const Job& job);
  [[nodiscard]] Status check_file(std::int64_t job, const Artifact& file,
                                  const std::function<bool()>& is_cancelled);
  void discard_unowned(std::int64_t id);

  JobChanges& changes_;
  Database& database_;
  Layout layout_;
  JobStoreOptions options_;
  FileHashes hashes_;
};

}  // namespace hydroprint::daemon
