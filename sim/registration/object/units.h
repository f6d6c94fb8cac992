#pragma once

#include <span>

#include "sim/registration/shape.h"
#include "sim/scan/cloud.h"

namespace hydroprint::registration {

/// Returns kFailedPrecondition if the scan is far larger or smaller than the mesh: WRONG_UNITS if
/// the mesh fits in metres, centimetres or inches, otherwise NOT_THIS_OBJECT.
/// @param points  of one connected piece
[[nodiscard]] Status check_size(const Shape& shape, std::span<const scan::ScanPoint> points);

}  // namespace hydroprint::registration
