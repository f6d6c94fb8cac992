#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/base/context.h"
#include "sim/mesh/surface.h"

namespace hydroprint::plan {

/// Largest number of dips of one object.
inline constexpr int kMaxDips = 12;

/// The stretch of the film, per dip and surface point: at least 0, +infinity where the film of that
/// dip does not arrive. Welded points have the value of their representative.
using Stretch = std::vector<std::vector<double>>;

/// A convex part of one triangle that belongs to one dip.
struct Fragment {
  int triangle = 0;
  int dip = 0;  ///< from 1; 0: no dip reaches the triangle
  std::size_t first_corner = 0;
  std::size_t corners = 0;
};

/// A surface divided among dips.
struct Fragments {
  std::vector<Fragment> all;             ///< by triangle, then by dip of least stretch
  std::vector<std::size_t> begin;        ///< per triangle, its first fragment; one more at the end
  std::vector<Eigen::Vector3d> corners;  ///< barycentric, counterclockwise as the triangle
  std::vector<std::uint16_t> reach;      ///< per triangle: bit k - 1 is set if dip k reaches it

  [[nodiscard]] std::span<const Eigen::Vector3d> polygon(std::size_t fragment) const {
    return std::span(corners).subspan(all[fragment].first_corner, all[fragment].corners);
  }
  [[nodiscard]] std::span<const Fragment> of_triangle(int triangle) const {
    const auto t = static_cast<std::size_t>(triangle);
    return std::span(all).subspan(begin[t], begin[t + 1] - begin[t]);
  }
  [[nodiscard]] bool reaches(int dip, int triangle) const {
    return (reach[static_cast<std::size_t>(triangle)] >> (dip - 1) & 1) != 0;
  }
  /// Returns the fragment at a point of a triangle; the nearest one if rounding leaves the point
  /// outside all of them.
  [[nodiscard]] std::size_t find(int triangle, const Eigen::Vector3d& barycentric) const;
  /// Returns the share of its triangle that a fragment covers.
  [[nodiscard]] double share(std::size_t fragment) const;
};

/// Divides each triangle among the dips that reach it, by least stretch (the lower envelope of
/// linear functions). A dip reaches a triangle if its stretch is finite at all three corners. Dips
/// with equal stretch at all three corners leave the triangle to the first of them.
/// @param stretch  1 to kMaxDips dips; one value for each point of the surface
/// @return kCancelled only
[[nodiscard]] Result<Fragments> divide_triangles(const mesh::Surface& surface,
                                                 const Stretch& stretch, const Context& context);

/// Returns for each point of the surface a corner (3 t + c for corner c of triangle t) that is
/// there and whose triangle a dip reaches: the first one. -1 if there is none. Welded points have
/// the same corner.
[[nodiscard]] std::vector<int> reached_corners(const mesh::Surface& surface,
                                               const Fragments& fragments);

/// Returns how far a point lies inside a convex polygon: the smallest barycentric-plane distance to
/// the lines of its edges, negative outside.
[[nodiscard]] double depth_inside(std::span<const Eigen::Vector3d> polygon,
                                  const Eigen::Vector3d& barycentric);

}  // namespace hydroprint::plan
