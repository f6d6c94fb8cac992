#include "sim/flow/jacobian.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "sim/base/check.h"

namespace hydroprint::flow {
namespace {

/// A triangle with a smaller stretch than this lies across a jump of the map. At 170 degrees, where
/// eq. (1) is clamped, a sphere compresses the film to cos(85 deg) = 0.087.
constexpr double kLeastStretch = 0.05;

using FilmCorners = std::array<Eigen::Vector2d, 3>;
using SurfaceCorners = std::array<Eigen::Vector3d, 3>;

SurfaceCorners corners_of(const Eigen::Vector3i& triangle,
                          const std::vector<Eigen::Vector3d>& points_mm) {
  return {points_mm[triangle[0]], points_mm[triangle[1]], points_mm[triangle[2]]};
}

/// Returns the gradient on a triangle; nullopt if it has a NaN corner or no area, if the film is
/// upside down there, or if it lies across a jump of the map.
std::optional<Gradient> usable_gradient(const FilmCorners& film_mm,
                                        const SurfaceCorners& surface_mm) {
  const Eigen::Vector2d u = film_mm[1] - film_mm[0];
  const Eigen::Vector2d v = film_mm[2] - film_mm[0];
  // The film touches the surface from outside, so orientation on the film is reversed.
  if (!(u.x() * v.y() - u.y() * v.x() < 0)) return {};
  const Gradient gradient = gradient_of(film_mm, surface_mm);
  if (gradient.isZero() || stretch_of(gradient).least < kLeastStretch) return {};
  return gradient;
}

}  // namespace

Stretch stretch_of(const Gradient& gradient) {
  // Singular values of a 2 x 3 matrix from its 2 x 2 Gram matrix; those of the inverse map are
  // their reciprocals.
  const Eigen::Matrix2d gram = gradient * gradient.transpose();
  const double mean = 0.5 * gram.trace();
  const double spread = std::hypot(0.5 * (gram(0, 0) - gram(1, 1)), gram(0, 1));
  const double largest = std::sqrt(mean + spread);
  const double smallest =
      largest > 0 ? std::sqrt(std::max(0.0, gram.determinant())) / largest : 0.0;
  return {1 / smallest, 1 / largest};
}

Gradient gradient_of(const std::array<Eigen::Vector2d, 3>& film_mm,
                     const std::array<Eigen::Vector3d, 3>& surface_mm) {
  Eigen::Matrix<double, 3, 2> surface;
  surface << surface_mm[1] - surface_mm[0], surface_mm[2] - surface_mm[0];
  Eigen::Matrix2d film;
  film << film_mm[1] - film_mm[0], film_mm[2] - film_mm[0];
  const Eigen::Matrix2d gram = surface.transpose() * surface;
  if (gram.determinant() <= 0) return Gradient::Zero();
  return film * gram.inverse() * surface.transpose();
}

std::vector<Gradient> point_gradients(const std::vector<Eigen::Vector2d>& film_mm,
                                      const std::vector<Eigen::Vector3d>& surface_mm,
                                      const std::vector<Eigen::Vector3i>& triangles) {
  HP_CHECK(film_mm.size() == surface_mm.size());
  std::vector<Gradient> sum(surface_mm.size(), Gradient::Zero());
  std::vector<double> weight(surface_mm.size(), 0);
  for (const Eigen::Vector3i& t : triangles) {
    const SurfaceCorners corners = corners_of(t, surface_mm);
    const auto gradient = usable_gradient({film_mm[t[0]], film_mm[t[1]], film_mm[t[2]]}, corners);
    if (!gradient) continue;
    const double area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
    for (const int corner : t) {
      sum[corner] += area * *gradient;
      weight[corner] += area;
    }
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t p = 0; p < sum.size(); ++p) {
    sum[p] = weight[p] > 0 ? Gradient(sum[p] / weight[p]) : Gradient::Constant(nan);
  }
  return sum;
}

std::vector<Stretch> point_stretch(const std::vector<FilmCorners>& film_mm,
                                   const std::vector<Eigen::Vector3d>& surface_mm,
                                   const std::vector<Eigen::Vector3i>& triangles) {
  HP_CHECK(film_mm.size() == triangles.size());
  std::vector<Stretch> sum(surface_mm.size());
  std::vector<int> count(surface_mm.size(), 0);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto gradient = usable_gradient(film_mm[t], corners_of(triangles[t], surface_mm));
    if (!gradient) continue;
    const Stretch here = stretch_of(*gradient);
    for (const int corner : triangles[t]) {
      sum[corner].most += here.most;
      sum[corner].least += here.least;
      ++count[corner];
    }
  }
  const double infinite = std::numeric_limits<double>::infinity();
  for (std::size_t p = 0; p < sum.size(); ++p) {
    sum[p] = count[p] > 0 ? Stretch{sum[p].most / count[p], sum[p].least / count[p]}
                          : Stretch{infinite, infinite};
  }
  return sum;
}

}  // namespace hydroprint::flow
