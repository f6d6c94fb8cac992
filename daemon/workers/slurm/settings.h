#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "daemon/config/config.h"

namespace hydroprint::daemon::slurm {

/// How to hand workers over to Slurm.
struct Settings {
  std::filesystem::path folder;  ///< on a file system that all nodes share
  /// Distinguishes daemons that share a folder or a user of Slurm: lower-case letters and digits.
  std::string installation = "default";
  std::string partition = {};             ///< empty: Slurm's default
  std::string account = {};               ///< empty: the user's default
  std::vector<std::string> options = {};  ///< more options of sbatch
  int jobs = 16;                          ///< maximum number of jobs that are handed over
  std::int64_t time_limit_s = 3600;       ///< of a job; Slurm counts whole minutes
};

/// Returns the settings of the section [workers.slurm].
[[nodiscard]] Settings settings_of(const Config& config);

/// Returns the folder of all executions of the installation.
[[nodiscard]] inline std::filesystem::path installation_folder(const Settings& settings) {
  return settings.folder / settings.installation;
}

/// Checks that no other user can change the scripts of jobs, which run as this user: the
/// installation's folder is not a link, belongs to this user, and gives no rights to others. A
/// missing folder passes.
/// @return kFailedPrecondition, which names the folder and the remedy
[[nodiscard]] Status check_installation_folder(const Settings& settings);

}  // namespace hydroprint::daemon::slurm
