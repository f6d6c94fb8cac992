#pragma once

#include <span>
#include <vector>

#include "sim/base/context.h"
#include "sim/registration/shape.h"
#include "sim/scan/cloud.h"

namespace hydroprint::registration {

/// Rough alignments of a body to a scan, best first. ICP starts from the nominal orientation, from
/// turns of 20 degrees around it, and from all quarter turns of it, so that every orientation is
/// within 63 degrees of a start. Each start moves the centre of the part that the camera would see
/// to the centre of the scan. Equal results are returned once.
/// @param most  largest number of results; that of the nominal pose is always added
[[nodiscard]] Result<std::vector<Pose>> rough_alignments(const Shape& shape,
                                                         std::span<const scan::ScanPoint> points,
                                                         const Pose& nominal_CB, std::size_t most,
                                                         const Context& context);

}  // namespace hydroprint::registration
