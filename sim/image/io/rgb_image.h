#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hydroprint::image {

using Rgb8 = std::array<std::uint8_t, 3>;

/// 8-bit sRGB, row 0 at the top, pixels R G B without padding.
struct RgbImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;

  [[nodiscard]] const std::uint8_t* at(int x, int y) const {
    return &rgb[3 * (static_cast<std::size_t>(y) * width + x)];
  }
  [[nodiscard]] std::uint8_t* at(int x, int y) {
    return &rgb[3 * (static_cast<std::size_t>(y) * width + x)];
  }
};

}  // namespace hydroprint::image
