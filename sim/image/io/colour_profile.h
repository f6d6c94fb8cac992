#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <tl/expected.hpp>

namespace hydroprint::image {

/// A conversion of 16-bit values to sRGB by an ICC profile (relative colorimetric, with black point
/// compensation), as browsers do it.
class ProfileToSrgb {
 public:
  /// Larger profiles are not used.
  static constexpr std::size_t kMaxProfile_bytes = std::size_t{16} << 20;

  /// @param profile   ICC profile of an RGB or grey colour space
  /// @param channels  colour channels of the image: 1 or 3
  /// @return otherwise the reason, for a sentence: "it is damaged"
  [[nodiscard]] static tl::expected<ProfileToSrgb, std::string> create(
      std::span<const std::uint8_t> profile, int channels);

  /// True if the profile is that of sRGB, up to half a step of 8 bits: nothing needs to be done.
  [[nodiscard]] bool is_srgb() const { return is_srgb_; }

  /// Number of values that a pixel needs as input: 3, or 1 for a grey profile.
  [[nodiscard]] int inputs() const { return inputs_; }

  /// Converts pixels: inputs() values each, to three sRGB-coded values each.
  void convert(const std::uint16_t* from, std::size_t count, std::uint16_t* to) const;

 private:
  ProfileToSrgb() = default;

  std::shared_ptr<void> transform_;
  int inputs_ = 3;
  bool is_srgb_ = false;
};

}  // namespace hydroprint::image
