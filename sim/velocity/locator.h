#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/velocity/film_mesh.h"

namespace hydroprint::velocity {

/// Finds the triangle of a film mesh that contains a point, in constant time for graded meshes.
class Locator {
 public:
  Locator() = default;
  explicit Locator(const FilmMesh& mesh);

  struct Place {
    int triangle = -1;
    /// Coordinates for corners 0, 1, 2; clamped into the triangle if the point is outside.
    Eigen::Vector3d barycentric;
    double outside_mm = 0;  ///< distance of the point from the film; 0: inside
  };

  /// Points farther than this from the film are not found, mm.
  static constexpr double kReach_mm = 1.0;

  /// Finds the triangle that contains the point or, outside the film, the nearest one within
  /// kReach_mm; triangle = -1 if there is none.
  /// @param guess  a triangle near the point to start from; -1: unknown
  [[nodiscard]] Place find(const Eigen::Vector2d& point_mm, int guess = -1) const;

 private:
  /// The data needed for one step of a walk, in one cache line.
  struct alignas(64) Corners {
    Eigen::Vector2d origin_mm;
    Eigen::Matrix2d to_barycentric;  ///< (point - origin) to the coordinates of corners 1 and 2
    Eigen::Vector3i neighbours;      ///< opposite each corner; -1: no neighbour
  };

  [[nodiscard]] bool holds(int triangle, const Eigen::Vector2d& point_mm, Place& place) const;
  [[nodiscard]] bool walk(int triangle, const Eigen::Vector2d& point_mm, Place& place) const;
  [[nodiscard]] Place find_nearest(const Eigen::Vector2d& point_mm, int cell) const;

  std::vector<Corners> triangles_;
  std::vector<Eigen::Matrix2d> edges_mm_;  ///< edges from corner 0 to the others
  Eigen::Vector2d origin_mm_ = Eigen::Vector2d::Zero();
  int columns_ = 0, rows_ = 0;
  /// For each cell, the triangles that overlap it, and the border triangles within kReach_mm of it.
  std::vector<int> inner_start_, inner_, near_start_, near_;
};

}  // namespace hydroprint::velocity
