#pragma once

#include <functional>
#include <string>

#include "daemon/config/config.h"

namespace hydroprint::admin {

/// Returns the configuration of a daemon with these flags, either of which may be empty, or why it
/// would not start with them.
using Configure = std::function<Result<daemon::Config>(const std::string& config_file,
                                                       const std::string& state_dir)>;

/// Implements `hydroprintd admin ...`, which `hydroprint admin` runs on the daemon's machine.
/// @param argv  arguments, starting with "admin"
/// @return the exit status
[[nodiscard]] int run_command(int argc, char** argv, const Configure& configure);

}  // namespace hydroprint::admin
