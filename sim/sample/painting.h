#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <functional>

#include "sim/image/io/rgb_image.h"

namespace hydroprint::sample {

/// An sRGB-coded colour, [0, 1].
using Colour = Eigen::Vector3f;

/// Draws a picture from a function of position (x to the right, y up, in the given unit). Each
/// pixel is the mean of `samples` x `samples` values.
[[nodiscard]] image::RgbImage draw(int width_px, int height_px, double units_per_px, int samples,
                                   const std::function<Colour(double x, double y)>& colour_at);

/// Blends b over a with the given weight.
[[nodiscard]] inline Colour mix(const Colour& a, const Colour& b, double weight) {
  const auto w = static_cast<float>(std::clamp(weight, 0.0, 1.0));
  return (1 - w) * a + w * b;
}

/// Returns 0 below `from`, 1 above `to`, and a smooth transition in between.
[[nodiscard]] inline double ramp(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Returns the distance to the nearest multiple of `spacing`.
[[nodiscard]] double to_nearest_line(double x, double spacing);

/// Returns true on every other square of a chessboard.
[[nodiscard]] bool is_dark_square(double x, double y, double size);

/// Returns smooth noise in about [-1, 1] with features about 1 apart: the sum of `octaves` layers
/// of value noise, each twice as fine and half as strong as the previous one.
[[nodiscard]] double noise(const Eigen::Vector3d& p, int octaves);

}  // namespace hydroprint::sample
