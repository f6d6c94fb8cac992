#include "hardware/capture/depth_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace hydroprint::capture {
namespace {

// The Viridis colour map at 11 equal steps. Linear interpolation between them is visually identical
// to the full map.
constexpr std::array<image::Rgb8, 11> kViridis{{{68, 1, 84},
                                                {72, 36, 117},
                                                {65, 68, 135},
                                                {53, 95, 141},
                                                {42, 120, 142},
                                                {33, 145, 140},
                                                {34, 168, 132},
                                                {68, 191, 112},
                                                {122, 209, 81},
                                                {189, 223, 38},
                                                {253, 231, 37}}};
constexpr image::Rgb8 kNotMeasured{150, 150, 150};
constexpr double kOutlierShare = 0.01;

/// @param t  0: far, 1: near; clamped to this range
image::Rgb8 colour_of(double t) {
  const double at = std::clamp(t, 0.0, 1.0) * (kViridis.size() - 1);
  const auto low = std::min<std::size_t>(static_cast<std::size_t>(at), kViridis.size() - 2);
  const double share = at - static_cast<double>(low);
  image::Rgb8 out{};
  for (std::size_t i = 0; i < 3; ++i) {
    out[i] = static_cast<std::uint8_t>(
        std::lround((1 - share) * kViridis[low][i] + share * kViridis[low + 1][i]));
  }
  return out;
}

/// Returns the nearest of the four pixels that are merged into one, so that thin objects are not
/// lost; 0 if none was measured.
std::uint16_t nearest_of(const depth_camera::DepthFrame& frame, int x, int y) {
  std::uint16_t out = 0;
  for (int v = 2 * y; v < 2 * y + 2; ++v) {
    for (int u = 2 * x; u < 2 * x + 2; ++u) {
      const std::uint16_t depth = frame.depth_mm[static_cast<std::size_t>(v) * frame.width + u];
      if (depth != 0 && (out == 0 || depth < out)) out = depth;
    }
  }
  return out;
}

}  // namespace

DepthPicture depth_picture(const depth_camera::DepthFrame& frame) {
  std::vector<std::uint16_t> seen;
  seen.reserve(frame.depth_mm.size());
  std::copy_if(frame.depth_mm.begin(), frame.depth_mm.end(), std::back_inserter(seen),
               [](std::uint16_t depth) { return depth != 0; });
  DepthPicture out;
  out.picture = {frame.width / 2, frame.height / 2, {}};
  out.picture.rgb.reserve(3 * static_cast<std::size_t>(out.picture.width) * out.picture.height);
  if (!seen.empty()) {
    const auto rank = [&seen](double share) {
      const auto place = seen.begin() + std::lround(share * static_cast<double>(seen.size() - 1));
      std::nth_element(seen.begin(), place, seen.end());
      return static_cast<int>(*place);
    };
    out.nearest_mm = rank(kOutlierShare);
    out.farthest_mm = rank(1 - kOutlierShare);
    out.measured_share =
        static_cast<double>(seen.size()) / static_cast<double>(frame.depth_mm.size());
  }
  const double range_mm = std::max(1, out.farthest_mm - out.nearest_mm);
  for (int y = 0; y < out.picture.height; ++y) {
    for (int x = 0; x < out.picture.width; ++x) {
      const std::uint16_t depth = nearest_of(frame, x, y);
      const image::Rgb8 colour =
          depth == 0 ? kNotMeasured : colour_of((out.farthest_mm - depth) / range_mm);
      out.picture.rgb.insert(out.picture.rgb.end(), colour.begin(), colour.end());
    }
  }
  return out;
}

}  // namespace hydroprint::capture
