#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "sim/mesh/model.h"

namespace hydroprint::mesh {

/// The model's surface prepared for simulation. Faces with edges longer than `max_edge_mm` are
/// subdivided and coincident vertices are welded. Normals are continuous on smooth parts and jump
/// at sharp edges. Frame O, mm.
struct Surface {
  /// The model's own vertices first, in its order; then those that subdivision added.
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3i> triangles;
  std::vector<int> source_triangle;  ///< per triangle: its index in Model::triangles
  /// Per triangle, three corners in barycentric coordinates (of corners 0, 1, 2) of its source.
  std::vector<std::array<Eigen::Vector3f, 3>> source_barycentric;
  std::vector<int> weld;  ///< per point: the first point with the same position (itself if none)
  /// Per triangle and corner: outward unit normal, angle-weighted over the faces around the corner
  /// that are connected to it without a crease (dihedral angle below 30 degrees).
  std::vector<std::array<Eigen::Vector3d, 3>> corner_normals;
  bool closed = false;  ///< every welded edge has exactly two triangles, consistently oriented
  Warnings warnings;    ///< assumptions: open, non-manifold, inside out, several shells
};

}  // namespace hydroprint::mesh
