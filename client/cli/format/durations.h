#pragma once

#include <CLI/CLI.hpp>
#include <optional>

namespace hydroprint::cli {

/// Adds a flag that takes a duration of at least 1 ms: "90", "90s", "1.5h", "10min" or "500ms". The
/// value is stored in seconds.
void add_duration(CLI::App& command, const char* flag, std::optional<double>& time_s,
                  const char* help);

}  // namespace hydroprint::cli
