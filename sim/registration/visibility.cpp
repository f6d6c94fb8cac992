#include "sim/registration/visibility.h"

#include <algorithm>
#include <cmath>

namespace hydroprint::registration {

std::vector<SurfacePoint> visible(const Shape& shape, const Pose& X_CB, std::size_t samples) {
  const Eigen::Vector3d eye_B = X_CB.inverse().translation();
  std::vector<SurfacePoint> out;
  for (const SurfacePoint& s : shape.samples(samples))
    if (shape.is_seen(s, eye_B)) out.push_back({X_CB * s.point_mm, X_CB.linear() * s.normal});
  return out;
}

Sight look_at(std::span<const SurfacePoint> visible_C, const scan::DepthFrame& depth,
              const scan::Lens& lens, double tolerance_mm) {
  Sight out;
  out.expected = visible_C.size();
  const double each = 1 / static_cast<double>(std::max<std::size_t>(out.expected, 1));
  for (const SurfacePoint& s : visible_C) {
    const Eigen::Vector2d pixel = lens.project(s.point_mm);
    const auto u = static_cast<int>(std::lround(pixel.x()));
    const auto v = static_cast<int>(std::lround(pixel.y()));
    if (u < 0 || v < 0 || u >= depth.width_px || v >= depth.height_px) {
      out.out_of_view += each;
      continue;
    }
    const double reported = depth.depth_mm[depth.index(u, v)];
    const double farther = lens.true_depth_mm(reported) - s.point_mm.z();
    if (!(reported > 0))
      out.without_depth += each;
    else if (farther > tolerance_mm)
      out.through += each;
    else if (farther < -tolerance_mm)
      out.before += each;
    else
      out.on += each;
  }
  return out;
}

}  // namespace hydroprint::registration
