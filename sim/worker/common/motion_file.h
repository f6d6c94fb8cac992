#pragma once

#include <filesystem>

#include "sim/base/result.h"
#include "sim/waterline/motion.h"

namespace hydroprint::worker {

/// Reads the measured path of a dip (`predict --motion`): a header `t_s,x_mm,y_mm,z_mm` and then 2
/// to 1,000,000 rows. Immersion and offset are relative to the first row, where the object has the
/// given pose. Fails on any other header, rows that are not four finite numbers, time that does not
/// increase, decreasing immersion, and an offset or immersion beyond 1e4 mm. Errors name the file
/// and the line.
[[nodiscard]] Result<waterline::Motion> read_motion(const std::filesystem::path& path);

}  // namespace hydroprint::worker
