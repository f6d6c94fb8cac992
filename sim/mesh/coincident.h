#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace hydroprint::mesh {

/// The faces that remain after faces on the same three points were merged.
struct DistinctFaces {
  std::vector<int> kept;   ///< indices of the triangles, ascending
  std::size_t copies = 0;  ///< dropped, because another face has the same points
  /// Dropped with their counterparts, because they divide two parts that touch.
  std::size_t walls = 0;
};

/// Merges faces that have the same three welded points, either way round: models exported
/// "double-sided", or twice. The first of such faces is kept. Faces that are given both ways round
/// and whose rim is on edges of two more faces each are walls between parts that touch, and so are
/// those that only meet such walls at their rim; they are dropped altogether, which unites the
/// parts.
[[nodiscard]] DistinctFaces merge_coincident(const std::vector<Eigen::Vector3i>& triangles,
                                             const std::vector<int>& weld);

}  // namespace hydroprint::mesh
