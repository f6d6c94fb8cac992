#pragma once

#include <cstdint>
#include <vector>

#include "sim/waterline/slicer.h"

namespace hydroprint::waterline {

/// A segment, and the mesh edges on which its ends lie.
struct CutSegment {
  Segment segment;
  std::uint64_t edge_a = 0, edge_b = 0;
};

/// Joins segments that share a mesh edge into closed curves. Segments whose direction is opposite
/// to the rest of their curve (faces that are inside out) are reversed together with their pull.
/// Open ends are closed by straight lines to equal or near ends, as README.md states.
[[nodiscard]] std::vector<Contour> join(const std::vector<CutSegment>& cuts);

}  // namespace hydroprint::waterline
