#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "daemon/store/job_store.h"
#include "daemon/workers/child_process.h"

namespace hydroprint::daemon {

/// The worker has not begun yet.
struct WorkerWaits {
  std::string reason;  ///< the engine's, in words
};

/// The worker runs, as far as the executor knows.
struct WorkerRuns {
  std::vector<std::string> progress = {};  ///< lines since the last observation
};

/// The worker has ended, and everything that it started.
struct WorkerEnds {
  int wait_status = 0;                     ///< as from waitpid()
  std::vector<std::string> progress = {};  ///< lines since the last observation
  std::string errors = {};                 ///< last bytes of its stderr
  std::string answer = {};                 ///< last bytes of its stdout
  bool exceeded_memory = false;            ///< ended because of its memory limit
  bool exceeded_time = false;              ///< ended by the executor because of its time limit
  bool exceeded_output = false;            ///< ended because it wrote too much
};

/// The executor is sure that the execution does not exist: it was never started, or has ended
/// without a trace.
struct WorkerIsGone {};

using Observation = std::variant<WorkerWaits, WorkerRuns, WorkerEnds, WorkerIsGone>;

/// Observations by job. A job that is missing had no answer: nothing is known about its worker.
using Observations = std::map<std::int64_t, Observation>;

/// Returns the observation of one job, if there is one.
[[nodiscard]] std::optional<Observation> of_job(const Observations& seen, std::int64_t job);

/// How to end a worker: so that it can clean up (SIGTERM), or without delay (SIGKILL).
enum class CancelHow : std::uint8_t { kGently, kAtOnce };

/// Answers of WorkerExecutor::adopt(). No answer means that nothing is known, never "gone".
enum class Adoption : std::uint8_t { kAdopted, kGone, kNoAnswer };

/// Runs workers: on this machine (LocalExecutor), or at an engine that has its own queue. It only
/// reports what happens; WorkerRun judges it. No call waits longer than about a second.
///
/// An execution without a handle may have been started or not; the executor finds it by its job,
/// attempt and folder.
///
/// Used by one thread at a time, except name(), outlives_daemon(), capacity() and runs(),
/// which are constant.
class WorkerExecutor {
 public:
  virtual ~WorkerExecutor() = default;
  WorkerExecutor(const WorkerExecutor&) = delete;
  WorkerExecutor& operator=(const WorkerExecutor&) = delete;

  /// Returns the name under which executions are stored.
  [[nodiscard]] virtual std::string name() const = 0;
  /// Returns whether its workers go on when the daemon ends.
  [[nodiscard]] virtual bool outlives_daemon() const = 0;
  /// Returns the number of executions that it takes at the same time.
  [[nodiscard]] virtual int capacity() const = 0;

  /// Returns the folder of the folders of executions (run_name()).
  [[nodiscard]] virtual std::filesystem::path runs(const Layout& layout) const {
    return layout.runs();
  }
  /// Returns why it cannot take executions now, though it may later.
  [[nodiscard]] virtual Status ready() { return {}; }
  /// Starts a worker, whose inputs and folder exist.
  /// @return the handle; empty if the executor cannot tell yet whether it was started. An error
  ///         means that it was not started and never will be.
  [[nodiscard]] virtual Result<std::string> start(const Execution& execution,
                                                  const Launch& launch) = 0;
  /// Observes executions that were started or adopted. An end is reported once or more often.
  [[nodiscard]] virtual Observations poll(const std::vector<Execution>& executions) = 0;
  /// Asks for the end of a worker, which poll() reports later. Can be called before adopt().
  /// @return an error if it was not delivered, and the caller has to try again
  [[nodiscard]] virtual Status cancel(const Execution& execution, CancelHow how) = 0;
  /// Takes over an execution of an earlier daemon. Adopted: poll() will report it, also if it has
  /// ended. Gone: it does not run and never will. Can be called repeatedly.
  [[nodiscard]] virtual Adoption adopt(const Execution& execution) = 0;

  /// Deletes the folders of all other executions, if they are not in the state folder.
  virtual void keep_only(const std::vector<Execution>& /*executions*/) {}

  /// Returns descriptors that become readable when poll() has something new. Without any, the
  /// caller polls at intervals.
  [[nodiscard]] virtual std::vector<int> descriptors() const { return {}; }

 protected:
  WorkerExecutor() = default;
};

/// Offers an execution to the executor. An execution of another executor has no answer, because
/// nobody can tell whether it runs, unless its workers die with the daemon: then it is gone.
[[nodiscard]] Adoption offer(WorkerExecutor& executor, const Execution& execution);

/// Returns the open executions that are not gone. To be called when the daemon starts, before any
/// job is called lost, and after the pool has stopped.
[[nodiscard]] Result<std::vector<Execution>> surviving(WorkerExecutor& executor, JobStore& store);

}  // namespace hydroprint::daemon
