#include "sim/flow/jacobian.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace hydroprint::flow {

Stretch stretch_of(const std::array<Eigen::Vector2d, 3>& film_mm,
                   const std::array<Eigen::Vector3d, 3>& surface_mm) {
  Eigen::Matrix2d film;
  film << film_mm[1] - film_mm[0], film_mm[2] - film_mm[0];
  const double infinity = std::numeric_limits<double>::infinity();
  if (film.determinant() == 0) return {infinity, infinity};
  Eigen::Matrix<double, 3, 2> surface;
  surface << surface_mm[1] - surface_mm[0], surface_mm[2] - surface_mm[0];
  const Eigen::Matrix<double, 3, 2> jacobian = surface * film.inverse();
  // Singular values of a 3 x 2 matrix from its 2 x 2 Gram matrix.
  const Eigen::Matrix2d gram = jacobian.transpose() * jacobian;
  const double mean = 0.5 * gram.trace();
  const double spread = std::hypot(0.5 * (gram(0, 0) - gram(1, 1)), gram(0, 1));
  const double most = std::sqrt(mean + spread);
  return {most, most > 0 ? std::sqrt(std::max(0.0, gram.determinant())) / most : 0};
}

}  // namespace hydroprint::flow
