#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "sim/base/context.h"
#include "sim/mesh/edges.h"
#include "sim/mesh/shell.h"

namespace hydroprint::mesh {

/// The triangles to flip so that all face outward, and the defects that were found.
struct Orientation {
  std::vector<bool> flip;        ///< whether to flip, for each triangle
  std::size_t inconsistent = 0;  ///< triangles flipped to agree with most of their neighbours
  std::size_t one_sided = 0;     ///< edges whose faces cannot agree (Moebius strips)
  std::size_t inside_out = 0;    ///< shells turned over as a whole
  std::size_t cavities = 0;      ///< closed shells that bound a cavity inside another shell
  std::size_t by_rays = 0;       ///< open shells whose outer side was found by rays
  std::size_t undecided = 0;     ///< open shells that look the same from both sides
  std::size_t shells = 0;        ///< parts that share no edge
  std::vector<Shell> largest;    ///< the kShellsListed largest by area, the largest first
  bool is_flat = true;           ///< no part encloses anything
};

/// Orients faces that share an edge of exactly two faces consistently, by flipping the minority.
/// Then turns over parts that do not face outward:
/// - A closed part faces outward if its volume is positive. It is a cavity if it lies within the
///   solid of another one and is the other way round than the outermost part around it.
/// - An open part faces outward if lines through it reach the open more often on its front than on
///   its back, or, if that is undecided, if they meet an even number of faces more often (Takayama
///   et al. 2014, "A simple method for correcting facet orientations in polygon meshes based on ray
///   casting"). If that is undecided as well, or if the part is hidden within a closed one, it is
///   closed by a cone to the middle of its boundary, and its volume decides. Flat parts that rays
///   cannot decide stay unchanged.
/// Takes about n log n time. The result does not depend on the number of threads.
/// @return kCancelled if the context is cancelled
[[nodiscard]] Result<Orientation> orient(const std::vector<Eigen::Vector3d>& points,
                                         const std::vector<int>& weld,
                                         const std::vector<Eigen::Vector3i>& triangles,
                                         const Edges& edges, const Context& context);

}  // namespace hydroprint::mesh
