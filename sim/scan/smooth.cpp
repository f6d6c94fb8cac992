#include "sim/scan/smooth.h"

#include <Eigen/Core>
#include <cmath>
#include <vector>

namespace hydroprint::scan {
namespace {

constexpr int kReach_patches = 2;
/// Maximum deviation of a depth from the mean of two opposite ones, in standard deviations.
constexpr double kBendSigmas = 3;

/// Returns the offsets to one pixel in each surrounding patch, but only one of each opposite pair.
std::vector<Eigen::Vector2i> half_of_neighbours(const DepthNoise& noise) {
  std::vector<Eigen::Vector2i> out;
  for (int dv = 0; dv <= kReach_patches; ++dv)
    for (int du = -kReach_patches; du <= kReach_patches; ++du)
      if (dv > 0 || du > 0) out.emplace_back(noise.patch_px * du, noise.patch_px * dv);
  return out;
}

/// Inverse depths, which are linear in the image on a plane; 0: no depth.
struct Inverse {
  int width_px, height_px;
  std::vector<float> values;

  explicit Inverse(const DepthFrame& frame) : width_px(frame.width_px), height_px(frame.height_px) {
    values.reserve(frame.depth_mm.size());
    for (const float depth : frame.depth_mm) values.push_back(depth > 0 ? 1 / depth : 0);
  }
  [[nodiscard]] float at(int u, int v) const {
    if (u < 0 || u >= width_px || v < 0 || v >= height_px) return 0;
    return values[static_cast<std::size_t>(v) * static_cast<std::size_t>(width_px) +
                  static_cast<std::size_t>(u)];
  }
};

/// @param most_bend  maximum difference of a pixel's inverse depth from the mean of an opposite
/// pair
float mean_around(const Inverse& inverse, const std::vector<Eigen::Vector2i>& neighbours, int u,
                  int v, float most_bend) {
  const float here = inverse.at(u, v);
  float sum = here;
  int count = 1;
  for (const Eigen::Vector2i& d : neighbours) {
    const float one = inverse.at(u + d.x(), v + d.y()), other = inverse.at(u - d.x(), v - d.y());
    if (one <= 0 || other <= 0 || std::abs((one + other) / 2 - here) > most_bend) continue;
    sum += one + other;
    count += 2;
  }
  return sum / static_cast<float>(count);
}

}  // namespace

Result<DepthFrame> smooth(const DepthFrame& frame, const DepthNoise& noise,
                          const Context& context) {
  const auto neighbours = half_of_neighbours(noise);
  const Inverse inverse(frame);
  DepthFrame out = frame;
  const auto smooth_row = [&](std::size_t v) -> Status {
    for (int u = 0; u < frame.width_px; ++u) {
      float& depth = out.depth_mm[frame.index(u, static_cast<int>(v))];
      if (!(depth > 0)) continue;
      const double bend_mm = kBendSigmas * std::sqrt(1.5) * noise.sigma_mm(depth);
      const auto most_bend = static_cast<float>(bend_mm / (static_cast<double>(depth) * depth));
      depth = 1 / mean_around(inverse, neighbours, u, static_cast<int>(v), most_bend);
    }
    return {};
  };
  HP_RETURN_IF_ERROR(
      parallel_for(context, "", static_cast<std::size_t>(frame.height_px), smooth_row));
  return out;
}

}  // namespace hydroprint::scan
