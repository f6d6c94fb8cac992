#pragma once

#include <string>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/io/printer_image.h"
#include "sim/image/io/rgb_image.h"
#include "sim/print/settings.h"

namespace hydroprint::print {

/// A film image in the printer's colours, and figures on its ink.
struct PrinterColoured {
  image::PrinterImage image;
  std::string icc_profile;   ///< of the printer, as given; empty: none
  double most_ink = 0;       ///< CMYK: largest C + M + Y + K of a pixel, in [0, 4]
  double limited_share = 0;  ///< CMYK: share of the pixels that the ink limit changed
};

/// Converts 8-bit sRGB to the printer's colours, consistently with ink::make_separation. White
/// means no ink, whatever the profile says, because white film carries none. Beyond the ink limit,
/// C, M and Y are reduced by the same factor, and K only if it exceeds the limit alone. The bytes
/// are the same for any number of threads.
/// Fails as ink::PrinterColours does, and with kOutOfRange for an ink limit out of range.
[[nodiscard]] Result<PrinterColoured> printer_coloured(const image::RgbImage& image,
                                                       const ColourSettings& settings,
                                                       const Context& context);

}  // namespace hydroprint::print
