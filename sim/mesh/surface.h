#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/mesh/model.h"
#include "sim/mesh/shell.h"

namespace hydroprint::mesh {

/// A set of the corners of a triangle: bit k for corner k.
using CornerSet = std::uint8_t;

/// The model's surface prepared for simulation. Edges longer than `max_edge_mm` are subdivided and
/// coincident vertices are welded. Normals are continuous on smooth parts and jump at sharp edges.
/// Frame O, mm.
struct Surface {
  /// First the model's own vertices in their order, then those that subdivision added.
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3i> triangles;
  std::vector<int> source_triangle;  ///< per triangle: its index in Model::triangles
  /// For each triangle, its three corners in barycentric coordinates of its source triangle.
  std::vector<std::array<Eigen::Vector3f, 3>> source_barycentric;
  std::vector<int> weld;  ///< per point: the first point with the same position (itself if none)
  /// For each triangle and corner, the outward unit normal: weighted by angle over the faces around
  /// the corner that are connected to it without a crease (dihedral angle below 30 degrees).
  std::vector<std::array<Eigen::Vector3d, 3>> corner_normals;
  /// For each triangle, the corners that lie inside another part, where no film arrives; empty:
  /// none do.
  std::vector<CornerSet> inner;
  /// Returns whether a corner of a triangle lies inside another part.
  [[nodiscard]] bool is_inner(std::size_t triangle, int corner) const {
    return !inner.empty() && (inner[triangle] >> corner & 1) != 0;
  }
  bool closed = false;   ///< every welded edge has exactly two triangles, consistently oriented
  bool is_flat = false;  ///< a sheet without thickness, which encloses nothing
  std::vector<Shell> shells;  ///< the kShellsListed largest by area, the largest first
  Warnings warnings;          ///< assumptions: open, non-manifold, inside out, several shells
};

}  // namespace hydroprint::mesh
