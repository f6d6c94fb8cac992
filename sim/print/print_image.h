#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/film/outline.h"
#include "sim/image/io/rgb_image.h"
#include "sim/print/colours.h"
#include "sim/print/layout.h"
#include "sim/print/page.h"
#include "sim/print/settings.h"

namespace hydroprint::print {

struct PrintSettings {
  PageSettings page;
  ColourSettings colours;
  /// Of the film image; none: the whole number of dots per inch that its size means.
  std::optional<double> dpi;
};

/// What goes to the printer.
struct Print {
  Layout layout;
  Document document;  ///< a page a sheet, its first image what is printed of the film image
  double dpi = 0;
  double most_ink = 0, limited_share = 0;  ///< see PrinterColoured
  double cut_off_mm2 = 0;  ///< of the image's colours, where the printer cannot print
  Warnings warnings;       ///< those of the layout, image_in_printer_margin
};

/// A film image as written by `simulate`, or any PNG, JPEG or TIFF: as 8-bit sRGB, transparency on
/// white. Refuses what image::read_image refuses.
[[nodiscard]] Result<image::RgbImage> read_film_image(const std::filesystem::path& path,
                                                      const Context& context);

/// Puts a film image on paper: exact scale, the printer's colours, marks (lay_out). The same bytes
/// for the same settings and the same font file, whenever and wherever.
/// @param name  of the image, for messages
/// Refuses (kInvalidArgument) an image that has not the size of a film image of this film
/// (contract, "Frames and units"), and what lay_out and printer_coloured refuse.
[[nodiscard]] Result<Print> print_image(const image::RgbImage& film_image, const std::string& name,
                                        const film::Outline& outline, const PrintSettings& settings,
                                        const Context& context);

}  // namespace hydroprint::print
