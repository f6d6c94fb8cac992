#include "sim/image/io/colour.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace hydroprint::image {
namespace {

float clamp01(float value) { return value > 0 ? std::min(value, 1.0F) : 0.0F; }

std::vector<std::uint8_t> make_srgb8_table() {
  std::vector<std::uint8_t> table(65536);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const float coded = srgb_from_linear(static_cast<float>(i) / 65535.0F);
    table[i] = static_cast<std::uint8_t>(std::lround(coded * 255.0F));
  }
  return table;
}

std::vector<std::uint16_t> make_linear16_table() {
  std::vector<std::uint16_t> table(65536);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const float linear = linear_from_srgb(static_cast<float>(i) / 65535.0F);
    table[i] = static_cast<std::uint16_t>(std::lround(linear * 65535.0F));
  }
  return table;
}

}  // namespace

float linear_from_srgb(float coded) {
  const float c = clamp01(coded);
  return c <= 0.04045F ? c / 12.92F : std::pow((c + 0.055F) / 1.055F, 2.4F);
}

float srgb_from_linear(float linear) {
  const float c = clamp01(linear);
  return c <= 0.0031308F ? c * 12.92F : 1.055F * std::pow(c, 1 / 2.4F) - 0.055F;
}

Eigen::Vector3f linear_from_srgb(const Eigen::Vector3f& coded) {
  return {linear_from_srgb(coded.x()), linear_from_srgb(coded.y()), linear_from_srgb(coded.z())};
}

Eigen::Vector3f srgb_from_linear(const Eigen::Vector3f& linear) {
  return {srgb_from_linear(linear.x()), srgb_from_linear(linear.y()), srgb_from_linear(linear.z())};
}

Srgb8Encoder::Srgb8Encoder() {
  static const std::vector<std::uint8_t> table = make_srgb8_table();
  table_ = table.data();
}

std::uint8_t srgb8_from_linear(float linear) { return Srgb8Encoder()(linear); }

std::uint16_t linear16_from_srgb16(std::uint16_t coded) {
  static const std::vector<std::uint16_t> table = make_linear16_table();
  return table[coded];
}

}  // namespace hydroprint::image
