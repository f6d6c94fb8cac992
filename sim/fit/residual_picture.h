#pragma once

#include "sim/base/result.h"
#include "sim/film/outline.h"
#include "sim/fit/fit.h"
#include "sim/image/io/rgb_image.h"

namespace hydroprint::fit {

/// Draws two pictures of the film seen from above, before and after the fit. They show its outline,
/// the measured points (grey: not used, red: outliers) and, from each used point, an arrow to its
/// prediction. The titles state the magnification of the arrows. The image is about 1600 pixels
/// wide. Returns the errors of text::Font::standard().
[[nodiscard]] Result<image::RgbImage> residual_picture(const film::Outline& outline,
                                                       const Outcome& outcome);

}  // namespace hydroprint::fit
