#pragma once

#include <span>
#include <vector>

#include "sim/base/context.h"
#include "sim/registration/shape.h"
#include "sim/scan/cloud.h"

namespace hydroprint::registration {

/// Rough alignments of a body to a scan, most promising first: ICP from the nominal turn, from
/// turns of 20 degrees around it, and from all quarter turns of it (which leaves no way for the
/// body to lie farther than 63 degrees from a start), each with the middle of what the camera would
/// see brought to the middle of the scan. Those that end alike count once.
/// @param most  so many at most, the nominal turn's own always among them
[[nodiscard]] Result<std::vector<Pose>> rough_alignments(const Shape& shape,
                                                         std::span<const scan::ScanPoint> points,
                                                         const Pose& nominal_CB, std::size_t most,
                                                         const Context& context);

}  // namespace hydroprint::registration
