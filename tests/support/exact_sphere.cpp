#include "tests/support/exact_sphere.h"

#include <cmath>

namespace hydroprint::exact {

double film_radius_mm(double sphere_mm, double vat_mm, double theta_rad) {
  const double k = std::sqrt(vat_mm * vat_mm / (sphere_mm * sphere_mm) - 1);
  const double turn = std::atan(1 / k) - std::atan(std::cos(theta_rad) / k);
  return vat_mm * std::sqrt(1 - std::exp(-2 / k * turn));
}

double contact_angle_rad(double sphere_mm, double vat_mm, double film_mm) {
  const double k = std::sqrt(vat_mm * vat_mm / (sphere_mm * sphere_mm) - 1);
  const double share = film_mm / vat_mm;
  const double turn = -0.5 * k * std::log1p(-share * share);
  return std::acos(k * std::tan(std::atan(1 / k) - turn));
}

}  // namespace hydroprint::exact
