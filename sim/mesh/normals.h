#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/mesh/edges.h"

namespace hydroprint::mesh {

/// Computes unit normals at triangle corners: the mean of the face normals around the corner,
/// weighted by angle. A face counts if it can be reached from the corner's own face without
/// crossing a crease (dihedral angle of 30 degrees or more), a boundary, or an edge of more than
/// two faces. Takes time linear in the number of triangles, regardless of how many meet at a point.
/// @return kCancelled if the context is cancelled
[[nodiscard]] Result<std::vector<std::array<Eigen::Vector3d, 3>>> corner_normals(
    const std::vector<Eigen::Vector3d>& points, const std::vector<Eigen::Vector3i>& triangles,
    const std::vector<int>& weld, const Edges& edges, const Context& context);

}  // namespace hydroprint::mesh
