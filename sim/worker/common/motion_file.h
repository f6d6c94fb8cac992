#pragma once

#include <filesystem>

#include "sim/base/result.h"
#include "sim/waterline/motion.h"

namespace hydroprint::worker {

/// Reads the path as driven (contract, `predict --motion`): a header `t_s,x_mm,y_mm,z_mm` and then
/// 2 to 1,000,000 rows. Immersion and offset count from the first row, where the pose holds.
/// Refuses, naming file and line: another header, rows of other than four finite numbers, time that
/// does not increase, an object that rises, a sideways offset beyond 1e4 mm.
[[nodiscard]] Result<waterline::Motion> read_motion(const std::filesystem::path& path);

}  // namespace hydroprint::worker
