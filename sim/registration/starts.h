#pragma once

#include <span>
#include <vector>

#include "sim/base/context.h"
#include "sim/registration/shape.h"
#include "sim/scan/cloud.h"

namespace hydroprint::registration {

/// Computes rough alignments of a body to a scan, best first. ICP starts from the nominal
/// orientation, from rotations of 20 degrees around it, and from all its quarter turns, so that
/// every orientation is within 63 degrees of an initial one. Each start moves the centre of the
/// part that the camera would see to the centre of the scan; the unchanged nominal pose is one more
/// start. Equal results are returned once.
/// @param most  maximum number of results; the result of the nominal pose is always added
[[nodiscard]] Result<std::vector<Pose>> rough_alignments(const Shape& shape,
                                                         std::span<const scan::ScanPoint> points,
                                                         const Pose& nominal_CB, std::size_t most,
                                                         const Context& context);

}  // namespace hydroprint::registration
