#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "client/cli/program/program.h"

namespace hydroprint::cli {

/// How `rig jog` jogs.
struct JogOptions {
  std::optional<double> speed_mm_per_s;  ///< positive is down; default: 2 by keys
  std::optional<double> time_s;          ///< how long; without it: as long as a key is held
  std::string with_lease;                ///< see add_lease_flag
};

/// Jogs by keys, or for a time. In the end the axis is stopped.
[[nodiscard]] Status jog(Program& program, const JogOptions& options);

}  // namespace hydroprint::cli
