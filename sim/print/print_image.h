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
  /// Resolution of the film image; nullopt: the whole number of dots per inch that matches its
  /// size.
  std::optional<double> dpi;
};

/// A film image prepared for the printer.
struct Print {
  Layout layout;
  Document document;  ///< one page per sheet; its first image is the sheet's part of the film image
  double dpi = 0;
  double most_ink = 0, limited_share = 0;  ///< see PrinterColoured
  double cut_off_mm2 = 0;  ///< coloured area in the printer's margin, which cannot be printed
  Warnings warnings;       ///< those of the layout, and IMAGE_IN_PRINTER_MARGIN
};

/// Reads a film image (written by `simulate`, or any PNG, JPEG or TIFF) as 8-bit sRGB with
/// transparency composited over white. Returns the errors of image::read_image().
[[nodiscard]] Result<image::RgbImage> read_film_image(const std::filesystem::path& path,
                                                      const Context& context);

/// Lays out a film image on paper at exact scale, in the printer's colours, with marks (lay_out).
/// Equal settings always yield equal bytes. Returns the errors of lay_out() and printer_coloured(),
/// and kInvalidArgument if the image does not have the size of a film image of this film.
/// @param name  of the image, for messages
[[nodiscard]] Result<Print> print_image(const image::RgbImage& film_image, const std::string& name,
                                        const film::Outline& outline, const PrintSettings& settings,
                                        const Context& context);

}  // namespace hydroprint::print
