#include "sim/image/io/pixels.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/image/io/colour.h"

namespace hydroprint::image {
namespace {

float clamped(float value) { return value > 0 ? std::min(value, 1.0F) : 0; }  // NaN becomes 0

}  // namespace

PixelConverter::PixelConverter(const PixelLayout& layout, ColourCoding coding,
                               const Decoding& decoding)
    : layout_(layout),
      coding_(std::move(coding)),
      decoding_(decoding),
      is_changed_(!decoding.tint.isOnes() || coding_.gamma ||
                  (decoding.opacity < 1 && decoding.alpha != Alpha::kIgnored) ||
                  (decoding.cutoff > 1 && decoding.alpha == Alpha::kCutOut)),
      converted_layout_{4, layout.alpha >= 0 ? 3 : -1, false, false, false} {}

bool PixelConverter::is_plain(const std::uint16_t* pixel, const PixelLayout& layout) const {
  if (is_changed_) return false;
  if (layout.alpha < 0 || pixel[layout.alpha] == 65535) return true;
  return decoding_.alpha == Alpha::kIgnored && !layout.premultiplied;
}

float PixelConverter::linear(float value) const {
  if (coding_.gamma) return std::pow(clamped(value), *coding_.gamma);
  return layout_.is_float ? clamped(value) : linear_from_srgb(value);
}

float PixelConverter::opacity(float alpha) const {
  if (decoding_.alpha == Alpha::kIgnored) return 1;
  const float opacity = clamped(alpha * decoding_.opacity);
  if (decoding_.alpha == Alpha::kCutOut) return opacity >= decoding_.cutoff ? 1.0F : 0.0F;
  return opacity;
}

Texel PixelConverter::texel(std::array<float, 3> colour, float alpha) {
  const float whole = clamped(alpha);
  const float visible = opacity(alpha);
  had_alpha_ = had_alpha_ || visible < 1;
  std::array<std::uint16_t, 3> out{};
  for (int i = 0; i < 3; ++i) {
    float value = colour[i];
    if (layout_.premultiplied && !coding_.profile && whole > 0 && whole < 1) value /= whole;
    value = linear(value) * decoding_.tint[i];
    out[i] = static_cast<std::uint16_t>(
        std::lround((clamped(value) * visible + (1 - visible)) * 65535.0F));
  }
  return {out[0], out[1], out[2], 0};
}

void PixelConverter::convert(const float* from, std::size_t count, Texel* to) {
  for (std::size_t i = 0; i < count; ++i, from += layout_.channels) {
    const float alpha = layout_.alpha >= 0 ? from[layout_.alpha] : 1;
    to[i] = layout_.grey ? texel({from[0], from[0], from[0]}, alpha)
                         : texel({from[0], from[1], from[2]}, alpha);
  }
}

void PixelConverter::convert(const std::uint16_t* from, std::size_t count, Texel* to) {
  if (coding_.profile) from = with_srgb(from, count);
  const PixelLayout& layout = coding_.profile ? converted_layout_ : layout_;
  for (std::size_t i = 0; i < count; ++i, from += layout.channels) {
    if (is_plain(from, layout)) {
      to[i].r = linear16_from_srgb16(from[0]);
      to[i].g = layout.grey ? to[i].r : linear16_from_srgb16(from[1]);
      to[i].b = layout.grey ? to[i].r : linear16_from_srgb16(from[2]);
      continue;
    }
    std::array<float, 3> colour{};
    for (int k = 0; k < 3; ++k) {
      colour[k] = static_cast<float>(from[layout.grey ? 0 : k]) / 65535.0F;
    }
    const float alpha =
        layout.alpha >= 0 ? static_cast<float>(from[layout.alpha]) / 65535.0F : 1.0F;
    to[i] = texel(colour, alpha);
  }
}

const std::uint16_t* PixelConverter::with_srgb(const std::uint16_t* from, std::size_t count) {
  const auto channels = static_cast<std::size_t>(layout_.channels);
  const auto inputs = static_cast<std::size_t>(coding_.profile->inputs());
  coded_.resize(inputs * count);
  srgb_.resize(3 * count);
  converted_.assign(4 * count, 65535);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < inputs; ++k)
      coded_[inputs * i + k] = unassociated(from + channels * i, layout_.grey ? 0 : k);
  }
  coding_.profile->convert(coded_.data(), count, srgb_.data());
  for (std::size_t i = 0; i < count; ++i) {
    std::copy_n(&srgb_[3 * i], 3, &converted_[4 * i]);
    if (layout_.alpha >= 0) converted_[4 * i + 3] = from[channels * i + layout_.alpha];
  }
  return converted_.data();
}

std::uint16_t PixelConverter::unassociated(const std::uint16_t* pixel, std::size_t channel) const {
  const std::uint16_t value = pixel[channel];
  if (!layout_.premultiplied || layout_.alpha < 0 || pixel[layout_.alpha] == 0) return value;
  const std::uint32_t alpha = pixel[layout_.alpha];
  return static_cast<std::uint16_t>(
      std::min<std::uint32_t>((65535U * value + alpha / 2) / alpha, 65535));
}

}  // namespace hydroprint::image
