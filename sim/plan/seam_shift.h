#pragma once

#include <vector>

#include "sim/base/context.h"
#include "sim/plan/regions.h"

namespace hydroprint::plan {

/// Returns the largest distance of a seam of one dip from another seam of it, in a straight line,
/// mm: of all points of the first one, from the nearest point of the second. 0 if the dip has no
/// seam in `seam`; infinity if it has one there but none in `from`. Accurate to kSeamSample_mm.
/// Errors: kCancelled.
[[nodiscard]] Result<double> seam_shift_mm(const std::vector<SeamSegment>& seam,
                                           const std::vector<SeamSegment>& from, int dip,
                                           const Context& context);

/// Distance of the points of a seam that are examined.
inline constexpr double kSeamSample_mm = 0.5;

}  // namespace hydroprint::plan
