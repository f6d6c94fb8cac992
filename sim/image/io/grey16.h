#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"

namespace hydroprint::image {

/// A 16-bit greyscale image (depths of a camera), row 0 at the top, without padding.
struct Grey16Image {
  int width = 0, height = 0;
  std::vector<std::uint16_t> grey;
};

/// Encodes the image as PNG, like encode_png(RgbImage), but without colour space and resolution:
/// the caller defines the meaning of the numbers.
[[nodiscard]] Result<std::vector<unsigned char>> encode_png(const Grey16Image& image,
                                                            const Context& context = {});

/// Writes the image like write_png(RgbImage).
[[nodiscard]] Status write_png(const std::filesystem::path& path, const Grey16Image& image,
                               const Context& context = {});

/// Reads a PNG or TIFF with 16 bits and one channel. Returns the errors of read_image(), and
/// kInvalidArgument for other images.
[[nodiscard]] Result<Grey16Image> read_grey16(const std::filesystem::path& path,
                                              const Context& context = {});

}  // namespace hydroprint::image
