#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "sim/mesh/surface.h"
#include "sim/plan/regions.h"

namespace hydroprint::testing {

/// Evaluates one function of place for each dip at all points of a surface.
[[nodiscard]] plan::Stretch stretch_of(
    const mesh::Surface& surface,
    const std::vector<std::function<double(const Eigen::Vector3d&)>>& dips);

/// Two dips of equal stretch where normal.dot(p) = 0; the first has less where it is positive.
[[nodiscard]] plan::Stretch two_dips(const mesh::Surface& surface, const Eigen::Vector3d& normal);

/// A flat rectangle in the plane of `u` and `v`, divided into squares of two triangles.
/// @param u, v  from the corner `origin` along the sides, full length
[[nodiscard]] mesh::Model rectangle(const Eigen::Vector3d& origin, const Eigen::Vector3d& u,
                                    const Eigen::Vector3d& v, int squares_u, int squares_v);

/// A place on a surface.
struct SurfacePoint {
  int triangle = 0;
  Eigen::Vector3d barycentric;
  Eigen::Vector3d place;
};

/// Random points in random triangles, the same for the same seed.
[[nodiscard]] std::vector<SurfacePoint> random_points(const mesh::Surface& surface, int count,
                                                      unsigned seed);

/// The point of the surface that is nearest to a place.
[[nodiscard]] SurfacePoint nearest_point(const mesh::Surface& surface,
                                         const Eigen::Vector3d& place);

}  // namespace hydroprint::testing
