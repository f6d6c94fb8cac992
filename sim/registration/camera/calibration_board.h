#pragma once

#include "sim/mesh/surface.h"

namespace hydroprint::registration {

/// The calibration board: two plates of 140 x 210 mm that slope down by 30 degrees on both sides of
/// a ridge. Each has six pyramids of 44 mm width and 25 mm height, 66 mm apart. One corner pyramid
/// is missing, which determines the board's orientation. The board has relief because a depth
/// camera cannot see print. The pyramids determine positions across the image. The slope of the
/// plates relates depth to these positions; with a flat board that cannot be separated from tilt.
/// Frame B: the ridge along y, its middle in the origin, pyramids along z.
[[nodiscard]] mesh::Surface calibration_board();

}  // namespace hydroprint::registration
