#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/base/context.h"
#include "sim/mesh/edges.h"
#include "sim/mesh/patches.h"

namespace hydroprint::mesh {

/// Unites the patches of each shell that the file orients as the surface of a union of solids: at
/// every edge, as many faces go one way as the other, and no point beside a face has a negative
/// winding number while some have a positive one (or the other way round). Solids that share edges
/// or faces are such shells. The united patch is closed, and oriented as in the file. The winding
/// numbers are found by rays from both sides of a few places of each patch.
/// @return kCancelled if the context is cancelled
[[nodiscard]] Result<Patches> unite_cycles(const std::vector<Eigen::Vector3d>& points,
                                           const std::vector<int>& weld,
                                           const std::vector<Eigen::Vector3i>& triangles,
                                           const Edges& edges, Patches found,
                                           const Context& context);

}  // namespace hydroprint::mesh
