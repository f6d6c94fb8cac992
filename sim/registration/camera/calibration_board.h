#pragma once

#include "sim/mesh/surface.h"

namespace hydroprint::registration {

/// The board that cameras are calibrated with: two plates of 140 x 210 mm that slope down by 30
/// degrees on both sides of a ridge, each with six pyramids of 44 mm width and 25 mm height, 66 mm
/// apart, but for one in a corner, which tells how the board is held. A depth camera sees no print,
/// so it takes relief: pyramids tell where things are across the image; the slope of the plates
/// tells how depth goes with that (of a flat board, that is not known apart from its tilt). Frame
/// B: the ridge along y, its middle in the origin, pyramids along z.
[[nodiscard]] mesh::Surface calibration_board();

}  // namespace hydroprint::registration
