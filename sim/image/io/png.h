#pragma once

#include <cstdint>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/io/rgb_image.h"

namespace hydroprint::image {

/// Filters and compresses rows of 8-bit samples as PNG image data (PNG specification, sections 9
/// and 10), a format that PDF also accepts. Bands of rows are compressed separately and in
/// parallel, because a printed page has 35 million pixels. The bytes are the same for any number of
/// threads. Errors: kInternal if memory runs out, kCancelled.
[[nodiscard]] Result<std::vector<unsigned char>> compress_rows(const std::uint8_t* samples,
                                                               int width, int height, int channels,
                                                               const Context& context);

/// Encodes an image as an 8-bit sRGB PNG with its resolution. Returns the errors of
/// compress_rows().
[[nodiscard]] Result<std::vector<unsigned char>> encode_png(const RgbImage& image, double dpi,
                                                            const Context& context = {});

}  // namespace hydroprint::image
