#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "sim/mesh/groups.h"

namespace hydroprint::mesh {

/// The sides of triangles, grouped by edge. Side s = 3 t + k of triangle t runs from its corner k
/// to its corner (k + 1) % 3. Two sides are on the same edge if their ends, after welding, are the
/// same.
class Edges {
 public:
  /// @param weld  for each point, its representative
  Edges(const std::vector<Eigen::Vector3i>& triangles, const std::vector<int>& weld);

  [[nodiscard]] std::size_t size() const { return begin_.size() - 1; }
  /// Returns the sides on edge e in ascending order: one at a boundary, two where the surface is
  /// manifold, otherwise more.
  [[nodiscard]] std::span<const int> sides(std::size_t e) const {
    return std::span(sides_).subspan(begin_[e], begin_[e + 1] - begin_[e]);
  }

 private:
  std::vector<int> sides_;
  std::vector<std::size_t> begin_;
};

/// The welded points at which a side begins and ends.
struct SideEnds {
  int from = 0;
  int to = 0;
};
[[nodiscard]] inline SideEnds side_ends(int side, const std::vector<Eigen::Vector3i>& triangles,
                                        const std::vector<int>& weld) {
  const auto& t = triangles[static_cast<std::size_t>(side / 3)];
  return {weld[static_cast<std::size_t>(t[side % 3])],
          weld[static_cast<std::size_t>(t[(side + 1) % 3])]};
}

/// Groups the triangles 0 ... count - 1 into shells: parts that share no edge.
[[nodiscard]] Groups shells_of(std::size_t count, const Edges& edges);

}  // namespace hydroprint::mesh
