#pragma once

#include <cstdint>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/io/rgb_image.h"

namespace hydroprint::image {

/// Filters and compresses rows of 8-bit samples as image data of a PNG (PNG specification, sections
/// 9 and 10), which PDF also accepts. Bands of rows are compressed separately and in parallel (a
/// printer's page has 35 million pixels). The bytes are the same for any number of threads. Errors:
/// kInternal if memory runs out, kCancelled.
[[nodiscard]] Result<std::vector<unsigned char>> compress_rows(const std::uint8_t* samples,
                                                               int width, int height, int channels,
                                                               const Context& context);

/// A PNG file's bytes: 8-bit sRGB with its resolution. Fails as compress_rows() does.
[[nodiscard]] Result<std::vector<unsigned char>> encode_png(const RgbImage& image, double dpi,
                                                            const Context& context = {});

}  // namespace hydroprint::image
