#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace hydroprint::scan {

/// A surface of triangles, in mm, with corners counter-clockwise as seen from outside.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> points_mm;
  std::vector<Eigen::Vector3i> triangles;
};

/// Returns corner c (0 to 7) of a unit cube, at (c & 1, c >> 1 & 1, c >> 2).
[[nodiscard]] inline Eigen::Vector3i cube_corner(int c) { return {c & 1, c >> 1 & 1, c >> 2}; }

/// Extracts the zero level set of a function given on a grid, cube by cube (marching tetrahedra,
/// Doi and Koide 1991). The surface is closed wherever all cubes around it are added.
class MarchingTetrahedra {
 public:
  /// @param count  grid points along each axis; point (0, 0, 0) lies half a spacing from the origin
  MarchingTetrahedra(const Eigen::Vector3i& count, const Eigen::Vector3d& origin_mm,
                     double spacing_mm);

  /// @param cell    the cube's lowest corner, a grid point
  /// @param values  at the cube's corners; positive outside
  void add(const Eigen::Vector3i& cell, const std::array<double, 8>& values);

  [[nodiscard]] TriangleMesh mesh() && { return std::move(mesh_); }

 private:
  void add_tetrahedron(const Eigen::Vector3i& cell, const std::array<double, 8>& values,
                       const std::array<int, 4>& corners);
  int cut(const Eigen::Vector3i& cell, const std::array<double, 8>& values, int a, int b);
  void add_triangle(Eigen::Vector3i corners, const Eigen::Vector3d& outward);

  Eigen::Vector3i count_;
  Eigen::Vector3d origin_mm_;
  double spacing_mm_;
  std::unordered_map<std::uint64_t, int> points_;  ///< keyed by an edge's lower end and direction
  TriangleMesh mesh_;
};

}  // namespace hydroprint::scan
