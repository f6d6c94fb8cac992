#pragma once

#include "sim/mesh/surface.h"

namespace hydroprint::registration {

/// Returns the calibration board: two plates of 140 x 210 mm that slope down by 30 degrees on both
/// sides of a ridge. Each has places for six pyramids of 44 mm width and 25 mm height, 66 mm apart.
/// One corner pyramid is missing, which makes the board's orientation unambiguous. The board has
/// relief because a depth camera cannot see print. The pyramids determine positions across the
/// image. The slope of the plates relates depth to these positions; on a flat board, depth cannot
/// be separated from tilt. Frame B: y along the ridge, origin in the middle of the ridge, pyramids
/// on the side of +z.
[[nodiscard]] mesh::Surface calibration_board();

}  // namespace hydroprint::registration
