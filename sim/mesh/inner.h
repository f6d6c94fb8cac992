#pragma once

#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/mesh/edges.h"
#include "sim/mesh/rays.h"
#include "sim/mesh/surface.h"

namespace hydroprint::mesh {

/// Returns the triangles of closed shells: those that share no edge with an open one.
[[nodiscard]] std::vector<Corners> closed_shells(const std::vector<Eigen::Vector3d>& points,
                                                 const std::vector<Eigen::Vector3i>& triangles,
                                                 const Edges& edges);

/// Finds the corners of triangles that no film can reach because they lie inside another part of
/// the model, as in figures made of overlapping bodies. Counts the crossings of rays from a point
/// just outside each corner with the closed shells, with their signs. Open shells hide nothing.
/// @param solids  closed_shells() of the surface, which may be from before its subdivision
/// @return see Surface::inner
[[nodiscard]] Result<std::vector<CornerSet>> inner_corners(const Surface& surface,
                                                           const std::vector<Corners>& solids,
                                                           const Context& context);

}  // namespace hydroprint::mesh
