#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/image/io/colour_profile.h"
#include "sim/image/io/image_file.h"

namespace hydroprint::image {

/// The channels of a file.
struct PixelLayout {
  int channels = 3;
  int alpha = -1;  ///< index of the alpha channel; -1: none
  bool premultiplied = false;
  bool grey = false;
  bool is_float = false;  ///< values are linear unless a gamma is given
};

/// The meaning of the colour values of a file. Without both members: sRGB, or linear floats.
struct ColourCoding {
  std::optional<ProfileToSrgb> profile;  ///< for integers
  std::optional<float> gamma;            ///< linear light is the value to this power
};

/// Converts the pixels of a file to texels.
class PixelConverter {
 public:
  PixelConverter(const PixelLayout& layout, ColourCoding coding, const Decoding& decoding);

  /// Converts pixels of floats, or of 16-bit integers.
  void convert(const float* from, std::size_t count, Texel* to);
  void convert(const std::uint16_t* from, std::size_t count, Texel* to);

  /// True if a pixel so far was transparent.
  [[nodiscard]] bool had_alpha() const { return had_alpha_; }

 private:
  /// True if the pixel is opaque and sRGB-coded.
  [[nodiscard]] bool is_plain(const std::uint16_t* pixel, const PixelLayout& layout) const;
  [[nodiscard]] float linear(float value) const;
  /// Returns the opacity that counts.
  [[nodiscard]] float opacity(float alpha) const;
  /// @param colour  values in [0, 1], coded as the file's
  [[nodiscard]] Texel texel(std::array<float, 3> colour, float alpha);
  /// Converts the pixels by the profile to sRGB, in converted_layout_.
  [[nodiscard]] const std::uint16_t* with_srgb(const std::uint16_t* from, std::size_t count);
  /// Returns a colour value that is not multiplied by the alpha.
  [[nodiscard]] std::uint16_t unassociated(const std::uint16_t* pixel, std::size_t channel) const;

  PixelLayout layout_;
  ColourCoding coding_;
  Decoding decoding_;
  bool is_changed_;               ///< opaque pixels need more than the sRGB curve
  PixelLayout converted_layout_;  ///< of pixels converted by the profile: R G B A
  bool had_alpha_ = false;
  std::vector<std::uint16_t> coded_, srgb_, converted_;  ///< buffers of with_srgb()
};

}  // namespace hydroprint::image
