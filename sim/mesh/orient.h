#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "sim/mesh/edges.h"

namespace hydroprint::mesh {

/// The triangles to flip so that all face outward, and the defects that were found.
struct Orientation {
  std::vector<bool> flip;        ///< whether to flip, for each triangle
  std::size_t inconsistent = 0;  ///< triangles flipped to agree with most of their neighbours
  std::size_t one_sided = 0;     ///< edges whose faces cannot agree (Moebius strips)
  std::size_t inside_out = 0;    ///< shells flipped because their volume was negative
  std::size_t cavities = 0;      ///< closed shells that bound a cavity inside another shell
  std::size_t shells = 0;        ///< parts that share no edge
  bool is_flat = false;          ///< no part has a volume
};

/// Orients faces that share an edge of exactly two faces consistently, by flipping the minority.
/// Then flips parts with a negative volume, except cavities inside another part. To measure
/// volumes, open parts are closed by a cone to the middle of their boundary. Flat parts stay
/// unchanged.
[[nodiscard]] Orientation orient(const std::vector<Eigen::Vector3d>& points,
                                 const std::vector<int>& weld,
                                 const std::vector<Eigen::Vector3i>& triangles, const Edges& edges);

}  // namespace hydroprint::mesh
