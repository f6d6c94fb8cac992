#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"

namespace hydroprint::image {

/// Numbers, 16 bits each (depths of a camera), row 0 on top, without padding.
struct Grey16Image {
  int width = 0, height = 0;
  std::vector<std::uint16_t> grey;
};

/// A PNG file's bytes, as encode_png(RgbImage) makes them, but without colour space or resolution:
/// what the numbers mean, the caller says.
[[nodiscard]] Result<std::vector<unsigned char>> encode_png(const Grey16Image& image,
                                                            const Context& context = {});

/// Writes one, as write_png(RgbImage) does.
[[nodiscard]] Status write_png(const std::filesystem::path& path, const Grey16Image& image,
                               const Context& context = {});

/// Reads one of 16 bits and one channel (PNG or TIFF). Refuses what read_image refuses, and
/// (kInvalidArgument) others.
[[nodiscard]] Result<Grey16Image> read_grey16(const std::filesystem::path& path,
                                              const Context& context = {});

}  // namespace hydroprint::image
