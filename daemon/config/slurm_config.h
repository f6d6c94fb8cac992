#pragma once

#include <string>
#include <vector>

#include "daemon/config/config.h"

namespace hydroprint::daemon {

/// Returns the words of workers.slurm.options.
[[nodiscard]] std::vector<std::string> slurm_options(const Config& config);

/// Checks the section [workers.slurm] if workers.executor is "slurm".
/// @return kInvalidArgument, CONFIG_INVALID, one line that names the key
[[nodiscard]] Status check_slurm(const Config& config);

}  // namespace hydroprint::daemon
