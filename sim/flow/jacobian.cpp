#include "sim/flow/jacobian.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/base/check.h"

namespace hydroprint::flow {
namespace {

/// A triangle with a smaller stretch than this lies across a jump of the map. At 170 degrees, where
/// eq. (1) is clamped, a sphere compresses the film to cos(85 deg) = 0.087.
constexpr double kLeastStretch = 0.05;

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
    const Eigen::Vector2d u = film_mm[t[1]] - film_mm[t[0]];
    const Eigen::Vector2d v = film_mm[t[2]] - film_mm[t[0]];
    // The film touches the surface from outside, so orientation on the film is reversed.
    if (!(u.x() * v.y() - u.y() * v.x() < 0)) continue;
    const Eigen::Vector3d& origin = surface_mm[t[0]];
    const double area = (surface_mm[t[1]] - origin).cross(surface_mm[t[2]] - origin).norm();
    const Gradient gradient = gradient_of({film_mm[t[0]], film_mm[t[1]], film_mm[t[2]]},
                                          {origin, surface_mm[t[1]], surface_mm[t[2]]});
    if (stretch_of(gradient).least < kLeastStretch) continue;
    for (const int corner : t) {
      sum[corner] += area * gradient;
      weight[corner] += area;
    }
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t p = 0; p < sum.size(); ++p) {
    sum[p] = weight[p] > 0 ? Gradient(sum[p] / weight[p]) : Gradient::Constant(nan);
  }
  return sum;
}

}  // namespace hydroprint::flow
