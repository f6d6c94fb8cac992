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

/// Computes the ink of a film image on its film: the amount for each pixel (make_separation), then
/// means over the cells. The image covers image::image_extent(); there is no ink outside it. The
/// result is bit-identical for any number of threads. Returns the errors of make_separation().
[[nodiscard]] Result<InkField> ink_of(const image::RgbImage& film_image,
                                      const film::Outline& outline, const InkOptions& options,
                                      const Context& context);

/// Same as ink_of(), for an image file (PNG, JPEG or TIFF of any size; transparency is white), read
/// as 8-bit sRGB. Also returns the errors of image::read_image().
[[nodiscard]] Result<InkField> read_ink_image(const std::filesystem::path& path,
                                              const film::Outline& outline,
                                              const InkOptions& options, const Context& context);

}  // namespace hydroprint::ink
