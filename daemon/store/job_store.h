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

/// A queued job as the order of starting sees it.
struct WaitingJob {
  std::int64_t id = 0;
  std::string owner;
  std::int32_t priority = 0;
  std::int64_t rank = 0;
};

/// Which jobs to list.
struct JobFilter {
  std::vector<JobState> states;  ///< empty: all
  std::string owner;             ///< empty: all
  std::int64_t before_id = 0;    ///< only older ones; 0: all
  int limit = 50;
};

/// Whether the queue stands still, and why.
struct QueuePause {
  bool paused = false;
  std::string reason;
};

/// Limits the store keeps.
struct JobStoreOptions {
  std::int64_t max_queued = 1000;
  std::int64_t keep_finished_ms = 30LL * 24 * 3600 * 1000;  ///< 0: for ever
  std::int64_t keep_dips_ms = 365LL * 24 * 3600 * 1000;     ///< of those at least; 0: for ever
  Quota quota = {};                                         ///< of each owner
};

/// Why running jobs are interrupted: the daemon is going down in order, or it was lost (killed, or
/// the machine with it) and the next one finds them running.
enum class Interruption { kShutdown, kLoss };

/// Jobs, their events and their artifacts' rows. Every change is one transaction that is on disk
/// when the call returns, with the event that tells of it; afterwards it is notified. Any thread
/// may call.
///
/// QUEUED -> RUNNING -> SUCCEEDED | FAILED, QUEUED -> CANCELLED, RUNNING -> CANCELLING ->
/// CANCELLED; RUNNING -> INTERRUPTED -> QUEUED when the daemon went down or was lost, but -> FAILED
/// (DAEMON_LOST) when it was lost for the third time; QUEUED -> SUCCEEDED from the cache.
/// Prints and captures: RUNNING at once, both -> CANCELLING -> CANCELLED, both -> INTERRUPTED.
/// Dips: WAITING_FOR_OPERATOR <-> RUNNING -> SUCCEEDED | FAILED, both -> CANCELLING -> CANCELLED,
/// both
/// -> INTERRUPTED.
///
/// Where a job is named that is not there: kNotFound, JOB_NOT_FOUND. Where its state does not allow
/// the change: kFailedPrecondition, STATE_FORBIDS. Where the disk fails: see Database::run().
class JobStore {
 public:
  JobStore(Database& database, const Layout& layout, const JobStoreOptions& options, Clock clock);

  /// Stores a job, or returns the one that the same request made before. A computed job with the
  /// inputs of one that succeeded gets that one's artifacts and is finished at once. Other jobs are
  /// RUNNING, dips WAITING_FOR_OPERATOR.
  /// @return kResourceExhausted: QUEUE_FULL, QUOTA_EXCEEDED; kFailedPrecondition: ASSET_MISSING, or
  ///   STATE_FORBIDS for a job that is not computed while another of its kind is not finished;
  ///   kInvalidArgument, REQUEST_ID_REUSED
  [[nodiscard]] Result<Job> create(const NewJob& made, const RequestKey& request);
  /// The job that the same request made before, if one did. REQUEST_ID_REUSED; JOB_NOT_FOUND if it
  /// was deleted.
  [[nodiscard]] Result<std::optional<Job>> repeated(const std::string& owner,
                                                    const RequestKey& request);
  /// Refuses (ASSET_MISSING) inputs that are not here.
  [[nodiscard]] Status check_inputs(const std::vector<InputFile>& inputs);

  [[nodiscard]] Result<Job> get(std::int64_t id);
  /// Newest first.
  [[nodiscard]] Result<std::vector<Job>> list(const JobFilter& filter);
  /// Deletes a finished job with all that belongs to it. STATE_FORBIDS, too, while there is the
  /// calibration that it made.
  [[nodiscard]] Status remove(std::int64_t id);
  /// Lets all who may look see its artifacts, or no longer.
  [[nodiscard]] Result<Job> share(std::int64_t id, bool shared);
  /// Keeps it beyond its time, or lets its time begin anew.
  [[nodiscard]] Result<Job> pin(std::int64_t id, bool pinned);
  /// QUEUED -> CANCELLED, RUNNING or WAITING_FOR_OPERATOR -> CANCELLING; CANCELLING and CANCELLED
  /// stay.
  [[nodiscard]] Result<Job> cancel(std::int64_t id);

  /// QUEUED -> RUNNING, or -> SUCCEEDED if an equal job has finished meanwhile.
  [[nodiscard]] Result<Job> start(std::int64_t id);
  /// Does nothing if the job does not run.
  [[nodiscard]] Status report(std::int64_t id, const Progress& progress);
  /// RUNNING -> SUCCEEDED; a job that someone asked to cancel becomes CANCELLED all the same.
  /// @param calibration  what it leaves, if that is one: there is both or neither
  [[nodiscard]] Result<Job> succeed(std::int64_t id, const std::vector<Artifact>& artifacts,
                                    const std::optional<NewCalibration>& calibration = {});
  /// RUNNING -> FAILED, CANCELLING -> CANCELLED.
  [[nodiscard]] Result<Job> give_up(std::int64_t id, const JobFailure& failure);
  /// A dip or print that is not finished: WAITING_FOR_OPERATOR or RUNNING, where it stands now
  /// (`dip_status`, of a dip), and how far it is. Does nothing to one that is CANCELLING.
  [[nodiscard]] Status advance(std::int64_t id, JobState state, const std::string& dip_status,
                               const Progress& progress, const std::string& message);
  /// The end of a dip or print with its record: SUCCEEDED, FAILED (with `failure`, which says it
  /// all), CANCELLED or INTERRUPTED.
  [[nodiscard]] Result<Job> end(std::int64_t id, JobState state,
                                const std::optional<JobFailure>& failure,
                                const std::string& dip_status, const std::vector<Artifact>& record,
                                const std::string& message);
  /// Dips that are not finished; at most one, but for what a crash left.
  [[nodiscard]] Result<std::vector<std::int64_t>> open_dips();
  /// RUNNING -> INTERRUPTED -> QUEUED (or FAILED, see above), CANCELLING -> CANCELLED, for all: to
  /// be called when no worker runs any more. Says why in the event.
  [[nodiscard]] Status interrupt_all(Interruption why);

  /// Artifacts by name; those after `after`.
  [[nodiscard]] Result<std::vector<Artifact>> artifacts(std::int64_t id, const std::string& after,
                                                        int limit);
  /// kNotFound, ARTIFACT_NOT_FOUND.
  [[nodiscard]] Result<Artifact> artifact(std::int64_t id, const std::string& name);

  /// Events of one job after `seq`, oldest first. kOutOfRange, EVENTS_GONE if `seq` was never
  /// given.
  [[nodiscard]] Result<std::vector<JobEvent>> events(std::int64_t id, std::int64_t after_seq,
                                                     int limit);
  /// The same of all jobs.
  [[nodiscard]] Result<std::vector<JobEvent>> all_events(std::int64_t after_seq, int limit);
  /// The newest event's number, 0 if there never was one.
  [[nodiscard]] Result<std::int64_t> last_seq();

  /// All queued jobs; order of starting within one owner.
  [[nodiscard]] Result<std::vector<WaitingJob>> waiting();
  [[nodiscard]] Result<std::vector<std::int64_t>> ids_in_state(JobState state);
  /// Computed jobs that are RUNNING, then those that are CANCELLING.
  [[nodiscard]] Result<std::vector<std::int64_t>> computing();
  /// Moves a queued job before another of its owner (0: behind all of them).
  [[nodiscard]] Result<Job> move(std::int64_t id, std::int64_t before);
  [[nodiscard]] Result<QueuePause> pause();
  [[nodiscard]] Status set_pause(const QueuePause& pause);

  /// Deletes finished jobs whose time is up, oldest first, and logs each; not those that are
  /// pinned, or made a calibration that is there, nor any while an open job reads artifacts, which
  /// may be theirs.
  [[nodiscard]] Status purge();
  /// Sets aside artifact folders that no job owns, empties the folder of runs, and applies the
  /// retention times of the options; only before the pool starts.
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
