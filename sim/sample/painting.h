#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <functional>

#include "sim/image/io/rgb_image.h"

namespace hydroprint::sample {

/// sRGB-coded, [0, 1].
using Colour = Eigen::Vector3f;

/// Draws a picture from a function of the place (x to the right, y up, in the given unit), as the
/// mean of so many samples a pixel in each direction.
[[nodiscard]] image::RgbImage draw(int width_px, int height_px, double units_per_px, int samples,
                                   const std::function<Colour(double x, double y)>& colour_at);

/// b over a, with the given weight.
[[nodiscard]] inline Colour mix(const Colour& a, const Colour& b, double weight) {
  const auto w = static_cast<float>(std::clamp(weight, 0.0, 1.0));
  return (1 - w) * a + w * b;
}

/// 0 below `from`, 1 above `to`, smooth between.
[[nodiscard]] inline double ramp(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Distance to the nearest multiple of `spacing`.
[[nodiscard]] double to_nearest_line(double x, double spacing);

/// True on every other square of a chessboard.
[[nodiscard]] bool is_dark_square(double x, double y, double size);

/// Smooth noise in about [-1, 1], of features about 1 apart with ever finer detail: `octaves` sums
/// of value noise, each twice as fine and half as strong.
[[nodiscard]] double noise(const Eigen::Vector3d& p, int octaves);

}  // namespace hydroprint::sample
