#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "client/cli/program/program.h"

namespace hydroprint::cli {

/// Options of `rig jog`.
struct JogOptions {
  std::optional<double> speed_mm_per_s;  ///< positive: down; nullopt: 2 mm/s when jogging with keys
  std::optional<double> time_s;          ///< duration; nullopt: while a key is held
  std::string with_lease;                ///< see add_lease_flag
};

/// Jogs by keys or for a given time. The axis is stopped at the end.
[[nodiscard]] Status jog(Program& program, const JogOptions& options);

}  // namespace hydroprint::cli
