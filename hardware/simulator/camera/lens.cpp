#include "hardware/simulator/camera/lens.h"

#include <cmath>
#include <random>

namespace hydroprint::simulated_camera {
namespace {

/// Middles and half widths of the ranges from which lenses are drawn. Khoshelham and Elberink
/// (Sensors 12, 2012, table 1): focal length 5.453 mm = 586 px, 1.8 % above the manufacturer's
/// value, principal point off by 7 and 4 px. Smisek, Jancosek and Pajdla (3D with Kinect, 2011):
/// 585.6 px, k1 = -0.13, k2 = 0.45, p1 and p2 of 0.001, depths off by 0.1 to 1 %.
constexpr double kFocalSpread = 0.02;
constexpr double kCentreSpread_px = 8;
constexpr double kK1 = -0.10, kK1Spread = 0.05;
constexpr double kK2 = 0.30, kK2Spread = 0.15;
constexpr double kTangentialSpread = 0.002;
constexpr double kDepthSpread = 0.01;

double between(std::mt19937_64& random, double middle, double spread) {
  // The results of std::uniform_real_distribution would differ between standard libraries.
  return middle + spread * (static_cast<double>(random() >> 11U) * 0x1p-52 - 1);
}

Eigen::Vector2d distorted(const Lens& lens, const Eigen::Vector2d& d) {
  const double r2 = d.squaredNorm();
  const double radial = 1 + r2 * (lens.k1 + r2 * lens.k2);
  return {d.x() * radial + 2 * lens.p1 * d.x() * d.y() + lens.p2 * (r2 + 2 * d.x() * d.x()),
          d.y() * radial + lens.p1 * (r2 + 2 * d.y() * d.y()) + 2 * lens.p2 * d.x() * d.y()};
}

}  // namespace

double horizontal_fov_rad() { return 2 * std::atan(kWidth_px / 2.0 / kFocal_px); }
double vertical_fov_rad() { return 2 * std::atan(kHeight_px / 2.0 / kFocal_px); }

Lens drawn_lens(std::uint64_t seed) {
  std::mt19937_64 random(seed ^ 0x6c656e73U);
  Lens out;
  out.focal_px *= between(random, 1, kFocalSpread);
  out.centre_px.x() += between(random, 0, kCentreSpread_px);
  out.centre_px.y() += between(random, 0, kCentreSpread_px);
  out.k1 = between(random, kK1, kK1Spread);
  out.k2 = between(random, kK2, kK2Spread);
  out.p1 = between(random, 0, kTangentialSpread);
  out.p2 = between(random, 0, kTangentialSpread);
  out.depth_scale = between(random, 1, kDepthSpread);
  return out;
}

Eigen::Vector2d project(const Lens& lens, const Eigen::Vector2d& direction) {
  return lens.centre_px + lens.focal_px * distorted(lens, direction);
}

Eigen::Vector2d unproject(const Lens& lens, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d wanted = (pixel - lens.centre_px) / lens.focal_px;
  // Distortion moves points by a few per cent, so the fixed-point iteration converges quickly.
  Eigen::Vector2d out = wanted;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d miss = wanted - distorted(lens, out);
    out += miss;
    if (miss.cwiseAbs().maxCoeff() < 1e-14) break;
  }
  return out;
}

}  // namespace hydroprint::simulated_camera
