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
  std::string icc_profile;   ///< profile of the printer, unchanged; empty: none
  double most_ink = 0;       ///< CMYK: largest C + M + Y + K of any pixel, in [0, 4]
  double limited_share = 0;  ///< CMYK: fraction of the pixels that the ink limit changed
};

/// Converts 8-bit sRGB to the printer's colours, consistently with ink::make_separation. White is
/// printed without ink, even if the profile assigns ink to it, because an unprinted film has none.
/// Beyond the ink limit, C, M and Y are reduced by the same factor, and K only if it alone exceeds
/// the limit. The bytes are the same for any number of threads. Returns the errors of
/// ink::PrinterColours, kOutOfRange for an ink limit out of range, and kInvalidArgument for an ink
/// limit with RGB.
[[nodiscard]] Result<PrinterColoured> printer_coloured(const image::RgbImage& image,
                                                       const ColourSettings& settings,
                                                       const Context& context);

}  // namespace hydroprint::print
