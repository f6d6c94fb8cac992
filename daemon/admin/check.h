#pragma once

#include <string>

#include "daemon/config/config.h"

namespace hydroprint::admin {

/// Returns the configuration file to check: `named`, or without a name the installed one if it
/// exists. Empty: built-in settings.
[[nodiscard]] std::string configuration_file(const std::string& named);

/// Implements `hydroprint admin check`: prints one line for each thing that the daemon needs to run
/// workers, and for each fault of its database and files. Changes nothing and needs no lock, so
/// that a daemon may be running.
/// @param file    name of the configuration, for the lines
/// @param config  of the daemon, or why it would not start with it
/// @return kDone, or kFailed if there is a fault; kCancelled after SIGINT or SIGTERM
[[nodiscard]] ExitStatus check(const std::string& file, const Result<daemon::Config>& config);

}  // namespace hydroprint::admin
