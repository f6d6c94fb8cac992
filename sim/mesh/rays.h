#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

namespace hydroprint::mesh {

/// The corners of a triangle.
using Corners = std::array<Eigen::Vector3d, 3>;

/// A triangle that a ray meets.
struct RayHit {
  std::size_t triangle = 0;
  bool from_behind = false;  ///< the ray passes from the back of the triangle to its front
};

/// Finds the triangles that rays meet (CGAL's AABB tree). Building it takes n log n time; a ray
/// takes about log n per hit. Rays that meet an edge may report both of its triangles or none.
class RayTree {
 public:
  explicit RayTree(const std::vector<Corners>& triangles);
  ~RayTree();
  RayTree(const RayTree&) = delete;
  RayTree& operator=(const RayTree&) = delete;

  /// Replaces `out` by all hits, in no particular order. May be called from several threads.
  void find_hits(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                 std::vector<RayHit>& out) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A line through a triangle.
struct Line {
  std::size_t triangle = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit vector towards the front side
};

/// Draws random lines through a set of triangles: points evenly by area, directions by Lambert's
/// cosine law. The same seed gives the same lines.
class LineSampler {
 public:
  /// @param corners  of all triangles; must outlive this object
  /// @param members  the triangles of the set; must outlive this object
  LineSampler(const std::vector<Corners>& corners, const std::vector<std::size_t>& members,
              std::uint64_t seed);

  /// Draws one line in each of `count` parts of equal area.
  [[nodiscard]] std::vector<Line> draw(std::size_t count);

 private:
  [[nodiscard]] double uniform();  ///< in [0, 1)
  [[nodiscard]] Line through(std::size_t triangle);

  const std::vector<Corners>& corners_;
  const std::vector<std::size_t>& members_;
  std::vector<double> area_until_;  ///< of the members up to each one
  std::mt19937_64 random_;
};

}  // namespace hydroprint::mesh
