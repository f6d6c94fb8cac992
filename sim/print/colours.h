#pragma once

#include <string>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/io/printer_image.h"
#include "sim/image/io/rgb_image.h"
#include "sim/print/settings.h"

namespace hydroprint::print {

/// A film image in the printer's colours, and what it takes.
struct PrinterColoured {
  image::PrinterImage image;
  std::string icc_profile;   ///< of the printer, as given; empty: none
  double most_ink = 0;       ///< CMYK: largest C + M + Y + K of a pixel, in [0, 4]
  double limited_share = 0;  ///< CMYK: of the pixels, those that the ink limit changed
};

/// Brings 8-bit sRGB to the printer's colours, as ink::make_separation reckons with when it asks
/// for amounts of ink. White is no ink, whatever the profile says: there the film carries none.
/// Beyond the ink limit C, M and Y become less by the same factor, K only where it alone is too
/// much. The same bytes whatever the number of threads.
/// Refuses (kOutOfRange) an ink limit out of range, and what ink::PrinterColours refuses.
[[nodiscard]] Result<PrinterColoured> printer_coloured(const image::RgbImage& image,
                                                       const ColourSettings& settings,
                                                       const Context& context);

}  // namespace hydroprint::print
