#pragma once

#include <cstdint>
#include <vector>

#include "sim/waterline/slicer.h"

namespace hydroprint::waterline {

/// A segment that still knows which mesh edges its ends lie on.
struct CutSegment {
  Segment segment;
  std::uint64_t edge_a = 0, edge_b = 0;
};

/// Joins segments that share a mesh edge into closed curves. Segments that run against the rest of
/// their curve (faces that are inside out) are turned round, their pull with them; curves left open
/// are closed by straight lines, end to nearest start.
[[nodiscard]] std::vector<Contour> join(const std::vector<CutSegment>& cuts);

}  // namespace hydroprint::waterline
