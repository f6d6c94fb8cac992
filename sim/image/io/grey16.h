#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"

namespace hydroprint::image {

/// Numbers of 16 bits each (depths of a camera), row 0 on top, without padding.
struct Grey16Image {
  int width = 0, height = 0;
  std::vector<std::uint16_t> grey;
};

/// A PNG file's bytes, as from encode_png(RgbImage), but without colour space or resolution: the
/// caller defines the meaning of the numbers.
[[nodiscard]] Result<std::vector<unsigned char>> encode_png(const Grey16Image& image,
                                                            const Context& context = {});

/// Writes such an image, as write_png(RgbImage) does.
[[nodiscard]] Status write_png(const std::filesystem::path& path, const Grey16Image& image,
                               const Context& context = {});

/// Reads a PNG or TIFF with 16 bits and one channel. Fails as read_image() does, and with
/// kInvalidArgument for other images.
[[nodiscard]] Result<Grey16Image> read_grey16(const std::filesystem::path& path,
                                              const Context& context = {});

}  // namespace hydroprint::image
