#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint::daemon {

/// States of a job; names, numbers and meanings are those of hydroprint.v1.Job.State.
enum class JobState : std::int8_t {
  kQueued = 1,
  kWaitingForOperator = 2,
  kRunning = 3,
  kCancelling = 4,
  kSucceeded = 5,
  kFailed = 6,
  kCancelled = 7,
  kInterrupted = 8,
};

/// Returns the state's name, for example "RUNNING".
[[nodiscard]] const char* name_of(JobState state);

/// Returns whether the state is final. (Computed jobs are INTERRUPTED only in their history; for
/// other jobs this state is final.)
[[nodiscard]] constexpr bool is_finished(JobState state) {
  return state == JobState::kSucceeded || state == JobState::kFailed ||
         state == JobState::kCancelled || state == JobState::kInterrupted;
}

/// Kinds of event; numbers as in hydroprint.v1.JobEvent.Kind.
enum class EventKind : std::int8_t { kStateChanged = 1, kProgress = 2, kMoved = 3 };

/// An input file of a job: the name under which the computation reads it, and the hash of its
/// bytes.
struct InputFile {
  std::string name;
  std::string sha256;
  bool operator==(const InputFile&) const = default;
};

/// The work of a job: the worker's verb (also the kind's name), the spec as proto3 JSON with all
/// references resolved, and the input files.
struct Work {
  std::string verb;
  std::string spec;
  std::vector<InputFile> inputs;
};

/// Properties of a job's kind that the store needs.
struct JobTraits {
  /// A worker computes the job: it is queued, and queued again if the daemon ends while it runs.
  /// Other jobs start immediately, one of each kind at a time, and end as INTERRUPTED in this case.
  bool computed = true;
  /// The job reads the artifacts of another job, which must not be deleted meanwhile.
  bool reads_artifacts = false;
  /// Advice that is appended to the event's message if the job is interrupted.
  std::string interrupted_advice = {};
};

/// Returns the SHA-256 of everything that determines the result of the work. `worker` is the
/// SHA-256 of the worker program.
[[nodiscard]] std::string input_digest(const Work& work, const std::string& worker);

/// A request id chosen by the client. It prevents a repeated request from being executed twice.
struct RequestKey {
  std::string method;
  std::string id;      ///< empty: no id
  std::string digest;  ///< SHA-256 of the request's content
};

/// The data of a new job.
struct NewJob {
  std::string display_name;
  std::string owner;
  std::int32_t priority = 0;
  std::string body;  ///< display name, labels and spec as the client sent them, serialised
  Work work;
  JobTraits traits;
  std::string digest;         ///< see input_digest()
  std::int64_t retry_of = 0;  ///< id of the job that this one retries; 0: none
  bool use_cache = true;
  std::int32_t threads = 0;  ///< number of the worker's threads; 0: the pool decides
  std::string dip_status;    ///< initial status of a dip: a serialised hydroprint.v1.DipStatus
};

/// Reason for a failed job; see hydroprint.v1.Failure. The error's `field` is the field
/// of the job at fault.
struct JobFailure {
  Error error;
  std::optional<std::int32_t> exit_status;
  std::optional<std::int32_t> signal;
};

/// Progress of a job; fractions in [0, 1].
struct Progress {
  double fraction = 0;
  std::string phase;
  double phase_fraction = 0;
  std::int64_t eta_ms = 0;     ///< Unix time; 0: unknown
  std::string waits_for = {};  ///< what it waits for before it computes; see hydroprint.v1.Job
};

/// A stored job. Times are Unix times in ms; 0 if not set.
struct Job {
  std::int64_t id = 0;
  std::string uid;
  NewJob definition;
  JobState state = JobState::kQueued;
  Progress progress;
  std::int64_t create_ms = 0, start_ms = 0, end_ms = 0, update_ms = 0, purge_ms = 0;
  std::int64_t version = 0;   ///< increases with every change
  std::int64_t attempts = 0;  ///< number of times that a computed job was started
  bool cache_hit = false;
  bool shared = false;  ///< see hydroprint.v1.Job.shared
  bool pinned = false;  ///< see hydroprint.v1.Job.pinned; purge_ms is then 0
  std::optional<JobFailure> failure;
  std::string dip_status;  ///< current status of a dip, as in NewJob::dip_status
};

/// One attempt to run a job in a worker, at a WorkerExecutor. It is open from the start of the
/// attempt until the end of the job, or its return to the queue, is stored.
struct Execution {
  std::int64_t job = 0;
  std::int64_t attempt = 0;  ///< 1 for the first start of the job
  std::string executor;      ///< WorkerExecutor::name()
  /// The executor's own name for it. Empty until start() has returned, and in the store for ever if
  /// the daemon is killed before that: the other members then identify the execution.
  std::string handle;
  std::filesystem::path folder;  ///< see RunFolder; never used by another attempt
};

/// A stored event of a job.
struct JobEvent {
  std::int64_t seq = 0;
  std::int64_t time_ms = 0;
  std::int64_t job = 0;
  EventKind kind = EventKind::kStateChanged;
  JobState state = JobState::kQueued;
  Progress progress;
  std::string message;
};

/// One file of a finished job.
struct Artifact {
  std::string name;
  std::int64_t size_bytes = 0;
  std::string sha256;
  std::string media_type;
};

}  // namespace hydroprint::daemon
