#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>

namespace hydroprint::image {

/// Apply the sRGB transfer function (IEC 61966-2-1) and its inverse. Both map [0, 1] to [0, 1] and
/// clamp values outside (NaN becomes 0).
[[nodiscard]] float linear_from_srgb(float coded);
[[nodiscard]] float srgb_from_linear(float linear);
[[nodiscard]] Eigen::Vector3f linear_from_srgb(const Eigen::Vector3f& coded);
[[nodiscard]] Eigen::Vector3f srgb_from_linear(const Eigen::Vector3f& linear);

/// Finds the nearest 8-bit sRGB code with a table: fast enough for every pixel of a film image.
class Srgb8Encoder {
 public:
  Srgb8Encoder();
  [[nodiscard]] std::uint8_t operator()(float linear) const {
    const float clamped = linear > 0 ? std::min(linear, 1.0F) : 0.0F;
    return table_[static_cast<int>(clamped * 65535.0F + 0.5F)];
  }

 private:
  const std::uint8_t* table_;
};

/// Same as Srgb8Encoder, for single values.
[[nodiscard]] std::uint8_t srgb8_from_linear(float linear);

/// Converts 16-bit sRGB codes to 16-bit linear light with a table. Srgb8Encoder converts the result
/// for an 8-bit code times 257 back to the same 8-bit code.
[[nodiscard]] std::uint16_t linear16_from_srgb16(std::uint16_t coded);

}  // namespace hydroprint::image
