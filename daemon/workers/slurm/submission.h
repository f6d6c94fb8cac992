#pragma once

#include <optional>
#include <string>

#include "daemon/workers/slurm/settings.h"
#include "daemon/workers/worker_executor.h"

namespace hydroprint::daemon::slurm {

/// Writes the script of an execution to its folder; see batch_script().
[[nodiscard]] Status write_script(const Settings& settings, const Execution& execution,
                                  const Launch& launch);

/// What became of a submission.
struct Submitted {
  /// Slurm's id. Empty if Slurm did not answer: then it may have accepted the job or not.
  std::string id = {};
};

/// Hands the script of an execution over to Slurm (sbatch), which must not start it again by
/// itself: the daemon counts attempts.
/// @return kInternal, WORKER_UNUSABLE with Slurm's words if it refused the job
[[nodiscard]] Result<Submitted> submit(const Execution& execution);

/// Asks Slurm to end the job of an execution (scancel): SIGTERM, and SIGKILL after its KillWait.
/// @return an error if Slurm did not answer
[[nodiscard]] Status end_job(const Settings& settings, const Execution& execution);

}  // namespace hydroprint::daemon::slurm
