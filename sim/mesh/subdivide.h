#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "sim/base/context.h"

namespace hydroprint::mesh {

/// The triangles of a surface under construction; see mesh::Surface for the members.
struct Patchwork {
  std::vector<Eigen::Vector3d> points;
  std::vector<int> weld;
  std::vector<Eigen::Vector3i> triangles;
  std::vector<int> source_triangle;
  std::vector<std::array<Eigen::Vector3f, 3>> source_barycentric;
};

/// Splits edges longer than `max_edge_mm` in half until none are left. Whether and where an edge is
/// cut depends only on its welded ends, so neighbouring triangles agree, also across seams.
/// Existing points keep their indices; new ones follow, one per cut edge. Error: kResourceExhausted
/// for more than `max_triangles`.
[[nodiscard]] Result<Patchwork> subdivide(Patchwork input, double max_edge_mm,
                                          std::size_t max_triangles, const Context& context);

}  // namespace hydroprint::mesh
