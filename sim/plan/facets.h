#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "sim/mesh/edges.h"
#include "sim/mesh/surface.h"

namespace hydroprint::plan {

/// A side of a triangle as a coordinate system of the triangle's plane.
struct SideFrame {
  Eigen::Vector2d origin;  ///< the corner at which the side begins
  Eigen::Vector2d along;   ///< unit vector along the side
  Eigen::Vector2d inward;  ///< unit vector into the triangle
  double length_mm = 0;

  [[nodiscard]] Eigen::Vector2d point(double x_mm) const { return origin + x_mm * along; }
};

/// The triangles of a surface, each laid flat, and how they are connected. Flat coordinates: corner
/// 0 is the origin, corner 1 is on the positive x axis, corner 2 has y > 0; mm. Sides are numbered
/// as in mesh::Edges. Triangles are connected across all sides on a welded edge, of which there may
/// be one, two or more.
class Facets {
 public:
  explicit Facets(const mesh::Surface& surface);

  [[nodiscard]] std::size_t size() const { return flat_.size(); }
  [[nodiscard]] const std::array<Eigen::Vector2d, 3>& corners(int triangle) const {
    return flat_[static_cast<std::size_t>(triangle)];
  }
  /// Returns the flat coordinates of a point given in barycentric coordinates.
  [[nodiscard]] Eigen::Vector2d flat(int triangle, const Eigen::Vector3d& barycentric) const {
    const auto& c = corners(triangle);
    return barycentric[0] * c[0] + barycentric[1] * c[1] + barycentric[2] * c[2];
  }
  [[nodiscard]] double area_mm2(int triangle) const {
    const auto& c = corners(triangle);
    return 0.5 * c[1].x() * c[2].y();
  }
  [[nodiscard]] SideFrame frame(int side) const;

  [[nodiscard]] const mesh::Edges& edges() const { return edges_; }
  [[nodiscard]] std::size_t edge(int side) const { return edge_[static_cast<std::size_t>(side)]; }
  /// Returns true if two sides of one edge run in the same direction.
  [[nodiscard]] bool same_direction(int side, int other) const {
    return from_[static_cast<std::size_t>(side)] == from_[static_cast<std::size_t>(other)];
  }

  /// Corners (3 t + c for corner c of triangle t) are the same vertex if they coincide and their
  /// triangles are connected across edges around it. Surfaces that only touch in a point have
  /// separate vertices there.
  [[nodiscard]] std::size_t vertices() const { return vertex_begin_.size() - 1; }
  [[nodiscard]] int vertex(int corner) const { return vertex_[static_cast<std::size_t>(corner)]; }
  [[nodiscard]] std::span<const int> corners_at(int vertex) const {
    const auto v = static_cast<std::size_t>(vertex);
    return std::span(vertex_corners_)
        .subspan(vertex_begin_[v], vertex_begin_[v + 1] - vertex_begin_[v]);
  }

 private:
  void join_corners();

  mesh::Edges edges_;
  std::vector<std::array<Eigen::Vector2d, 3>> flat_;
  std::vector<std::size_t> edge_;  ///< per side
  std::vector<int> from_;          ///< per side: the welded point at which it begins
  std::vector<int> vertex_;        ///< per corner
  std::vector<std::size_t> vertex_begin_;
  std::vector<int> vertex_corners_;
};

/// Returns the area of a triangle, mm2.
[[nodiscard]] double area_mm2(const mesh::Surface& surface, std::size_t triangle);

/// Returns the place of a point given in barycentric coordinates; frame O, mm.
[[nodiscard]] Eigen::Vector3d place_of(const mesh::Surface& surface, int triangle,
                                       const Eigen::Vector3d& barycentric);

/// Returns the point of a side at a fraction of its length, in barycentric coordinates.
[[nodiscard]] Eigen::Vector3d on_side(int side, double fraction);

}  // namespace hydroprint::plan
