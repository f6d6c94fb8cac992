#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "sim/mesh/edges.h"

namespace hydroprint::mesh {

/// A connected set of boundary edges.
struct Hole {
  Eigen::Vector3d middle_mm = Eigen::Vector3d::Zero();  ///< mean over the length of its edges
  double length_mm = 0;                                 ///< sum of its edges
  std::size_t edges = 0;
};

/// Groups the boundary edges that are connected by welded points, the longest group first. Two
/// holes that touch in a point are one.
[[nodiscard]] std::vector<Hole> holes_of(const std::vector<Eigen::Vector3d>& points,
                                         const std::vector<int>& weld,
                                         const std::vector<Eigen::Vector3i>& triangles,
                                         const Edges& edges);

}  // namespace hydroprint::mesh
