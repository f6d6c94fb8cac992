#pragma once

#include <span>

#include "sim/registration/shape.h"
#include "sim/scan/cloud.h"

namespace hydroprint::registration {

/// @param points  of one piece
/// Refuses (kFailedPrecondition) a scan that is far larger or smaller than the mesh: WRONG_UNITS
/// where metres, inches or centimetres explain it, else NOT_THIS_OBJECT.
[[nodiscard]] Status check_size(const Shape& shape, std::span<const scan::ScanPoint> points);

}  // namespace hydroprint::registration
