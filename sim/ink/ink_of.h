#pragma once

#include <filesystem>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/film/outline.h"
#include "sim/image/io/rgb_image.h"
#include "sim/ink/ink_field.h"

namespace hydroprint::ink {

struct InkOptions {
  std::filesystem::path icc_profile;  ///< film::Profile::ink_icc_profile; empty: naive CMYK
  double cell_mm = kInkCell_mm;
};

/// The ink that a film image puts on its film: each pixel's amount (make_separation), then means
/// over the cells. The image lies as image::image_extent says; what is outside it has no ink. The
/// same bits whatever the number of threads. Refuses what make_separation refuses.
[[nodiscard]] Result<InkField> ink_of(const image::RgbImage& film_image,
                                      const film::Outline& outline, const InkOptions& options,
                                      const Context& context);

/// The same for an image file (PNG, JPEG or TIFF, any number of pixels; transparency is white), by
/// its 8-bit sRGB codes. Refuses what image::read_image refuses, too.
[[nodiscard]] Result<InkField> read_ink_image(const std::filesystem::path& path,
                                              const film::Outline& outline,
                                              const InkOptions& options, const Context& context);

}  // namespace hydroprint::ink
