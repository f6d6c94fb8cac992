#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/workers/slurm/settings.h"
#include "daemon/workers/worker_executor.h"

namespace hydroprint::daemon::slurm {

/// Returns the options of sbatch for the job of an execution.
[[nodiscard]] std::vector<std::string> sbatch_options(const Settings& settings,
                                                      const Execution& execution,
                                                      const Launch& launch);

/// Writes the script of an execution to its folder; see batch_script().
[[nodiscard]] Status write_script(const Settings& settings, const Execution& execution,
                                  const Launch& launch);

/// What became of a submission.
struct Submitted {
  std::string id = {};     ///< Slurm's; empty: it is unknown whether Slurm has the job
  bool is_silent = false;  ///< Slurm did not answer in time
  std::string words = {};  ///< why Slurm does not take the job now, in its words; empty: unknown
};

/// Hands the script of an execution over to Slurm (sbatch), which must not start it again by
/// itself: the daemon counts attempts.
/// @return kInternal, WORKER_UNUSABLE with Slurm's words if it will never take the job
[[nodiscard]] Result<Submitted> submit(const Execution& execution);

/// Asks Slurm to end the jobs of a name (scancel): SIGTERM, and SIGKILL after its KillWait.
/// @param folder  working directory of scancel
/// @return an error if Slurm did not answer
[[nodiscard]] Status end_job(const std::string& name, const std::filesystem::path& folder);

}  // namespace hydroprint::daemon::slurm
