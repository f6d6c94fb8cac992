#pragma once

#include <optional>
#include <vector>

#include "sim/overlay/outlines.h"

namespace hydroprint::overlay {

/// Returns the region in which the winding number of group 0 is not zero, without triangles, if the
/// lines form simple closed curves that have no point in common and count once; otherwise nullopt.
/// @param lines  as split_at_meetings() returns them
[[nodiscard]] std::optional<Region> region_in_disjoint_curves(const std::vector<GridLine>& lines);

}  // namespace hydroprint::overlay
