#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/io/image_file.h"

namespace hydroprint::image {

/// An image for a printer: 8-bit samples, row 0 at the top, without padding; 3 per pixel (R G B) or
/// 4 (C M Y K, 255 is full ink).
struct PrinterImage {
  int width = 0, height = 0, channels = 3;
  std::vector<std::uint8_t> samples;

  [[nodiscard]] std::size_t row_bytes() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
  }
  [[nodiscard]] const std::uint8_t* at(int x, int y) const {
    return &samples[row_bytes() * y + static_cast<std::size_t>(x) * channels];
  }
  [[nodiscard]] std::uint8_t* at(int x, int y) {
    return &samples[row_bytes() * y + static_cast<std::size_t>(x) * channels];
  }
};

/// Encodes an RGB image (3 channels) as a PNG with its resolution and an ICC profile; an empty
/// profile means sRGB. Returns the errors of compress_rows() (png.h).
[[nodiscard]] Result<std::vector<unsigned char>> encode_png(const PrinterImage& image, double dpi,
                                                            const std::string& icc_profile,
                                                            const Context& context = {});

/// Writes a printer image as a TIFF (LZW) with its resolution and, unless empty, the ICC profile of
/// its colours. The number of channels selects RGB or CMYK. Returns the errors of write_png().
[[nodiscard]] Status write_tiff(const std::filesystem::path& path, const PrinterImage& image,
                                double dpi, const std::string& icc_profile);

/// Converts one row of an image to 8-bit sRGB codes; `rgb` has space for three bytes per texel.
void srgb8_row(const Texels& image, int y, std::uint8_t* rgb);

}  // namespace hydroprint::image
