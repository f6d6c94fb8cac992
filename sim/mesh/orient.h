#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "sim/mesh/edges.h"

namespace hydroprint::mesh {

/// Which triangles to turn over so that all look outward, and what was found on the way.
struct Orientation {
  std::vector<bool> flip;        ///< per triangle
  std::size_t inconsistent = 0;  ///< triangles turned to agree with most of their neighbours
  std::size_t one_sided = 0;     ///< edges that disagree whatever is turned (Moebius strips)
  std::size_t inside_out = 0;    ///< shells turned because their volume was negative
  std::size_t cavities = 0;      ///< closed shells that bound a hollow inside another
  std::size_t shells = 0;        ///< parts that share no edge
};

/// Neighbours over edges of two faces are made to agree, the fewer follow the more; then parts with
/// a negative volume are turned over, but for hollows inside another part. Open parts are closed by
/// a cone to the middle of their boundary for this purpose; flat ones are left as they are.
[[nodiscard]] Orientation orient(const std::vector<Eigen::Vector3d>& points,
                                 const std::vector<int>& weld,
                                 const std::vector<Eigen::Vector3i>& triangles, const Edges& edges);

}  // namespace hydroprint::mesh
