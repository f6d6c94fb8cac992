#include "sim/scan/lens.h"

#include <cmath>

namespace hydroprint::scan {
namespace {

constexpr int kMostSteps = 30;
constexpr double kSettled = 1e-13;

double radial(const Lens& lens, const Eigen::Vector2d& flat) {
  const double r2 = flat.squaredNorm();
  return 1 + r2 * (lens.k1 + r2 * lens.k2);
}

Eigen::Vector2d tangential(const Lens& lens, const Eigen::Vector2d& flat) {
  const double r2 = flat.squaredNorm(), x = flat.x(), y = flat.y();
  return {2 * lens.p1 * x * y + lens.p2 * (r2 + 2 * x * x),
          lens.p1 * (r2 + 2 * y * y) + 2 * lens.p2 * x * y};
}

}  // namespace

Eigen::Vector2d Lens::project(const Eigen::Vector3d& p_C) const {
  const Eigen::Vector2d flat = p_C.head<2>() / p_C.z();
  const Eigen::Vector2d bent = radial(*this, flat) * flat + tangential(*this, flat);
  return {cx_px + fx_px * bent.x(), cy_px + fy_px * bent.y()};
}

Eigen::Vector3d Lens::ray(double u, double v) const {
  const Eigen::Vector2d bent((u - cx_px) / fx_px, (v - cy_px) / fy_px);
  Eigen::Vector2d flat = bent;
  for (int i = 0; i < kMostSteps; ++i) {
    const Eigen::Vector2d next = (bent - tangential(*this, flat)) / radial(*this, flat);
    const double moved = (next - flat).norm();
    flat = next;
    if (moved < kSettled) break;
  }
  return {flat.x(), flat.y(), 1};
}

std::vector<Eigen::Vector3d> Lens::rays() const {
  std::vector<Eigen::Vector3d> out;
  out.reserve(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px));
  for (int v = 0; v < height_px; ++v)
    for (int u = 0; u < width_px; ++u) out.push_back(ray(u, v));
  return out;
}

Lens::Vector Lens::parameters() const {
  Vector p;
  p << fx_px, fy_px, cx_px, cy_px, k1, k2, p1, p2, depth_scale;
  return p;
}

Lens Lens::with(const Vector& p) const {
  return {width_px, height_px, p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8]};
}

Eigen::Matrix<double, 3, Lens::kParameters> Lens::derivatives(double u, double v,
                                                              double reported_mm) const {
  static const Vector kSteps =
      (Vector() << 0.1, 0.1, 0.1, 0.1, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3).finished();
  Eigen::Matrix<double, 3, kParameters> out;
  const Vector here = parameters();
  for (int j = 0; j < kParameters; ++j) {
    Vector above = here, below = here;
    above[j] += kSteps[j];
    below[j] -= kSteps[j];
    out.col(j) = (with(above).point(u, v, reported_mm) - with(below).point(u, v, reported_mm)) /
                 (2 * kSteps[j]);
  }
  return out;
}

}  // namespace hydroprint::scan
