#pragma once

#include <algorithm>
#include <cmath>

namespace hydroprint::mesh {

/// Codes linear light as sRGB (IEC 61966-2-1), limited to [0, 1]. glTF's factors and vertex colours
/// are linear.
[[nodiscard]] inline float srgb_of_linear(double linear) {
  const double c = std::clamp(linear, 0.0, 1.0);
  return static_cast<float>(c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055);
}

}  // namespace hydroprint::mesh
