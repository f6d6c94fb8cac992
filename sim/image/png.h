#pragma once

#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/picture.h"

namespace hydroprint::image {

/// A PNG file's bytes: 8-bit sRGB with its resolution. Bands of rows are compressed by themselves,
/// in parallel (a printer's page has 35 million pixels); the bytes are the same for any number of
/// threads. Fails (kInternal) when memory does not suffice, kCancelled.
[[nodiscard]] Result<std::vector<unsigned char>> encode_png(const RgbImage& image, double dpi,
                                                            const Context& context = {});

}  // namespace hydroprint::image
