#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "sim/base/context.h"
#include "sim/mesh/edges.h"

namespace hydroprint::mesh {

/// Triangles connected across edges of exactly two faces, or the surface of solids that share
/// edges.
struct Patch {
  std::vector<std::size_t> triangles;
  double area_mm2 = 0;
  /// Positive if the faces look outward after Patches::flip. Open patches are closed by a cone to
  /// the middle of their boundary.
  double volume_mm3 = 0;
  bool is_closed = true;      ///< without boundary, and with two sides
  bool is_one_sided = false;  ///< like a Moebius strip
  bool is_flat = false;       ///< its volume is negligible, and set to zero
};

/// The patches of a mesh, and the triangles to flip so that the faces of each patch agree.
struct Patches {
  std::vector<Patch> patches;    ///< in the order of their first triangles
  std::vector<bool> flip;        ///< for each triangle; the minority of each patch
  std::size_t inconsistent = 0;  ///< triangles to flip
  std::size_t one_sided = 0;     ///< edges whose faces cannot agree (Moebius strips)
};

[[nodiscard]] Patches find_patches(const std::vector<Eigen::Vector3d>& points,
                                   const std::vector<int>& weld,
                                   const std::vector<Eigen::Vector3i>& triangles,
                                   const Edges& edges);

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
