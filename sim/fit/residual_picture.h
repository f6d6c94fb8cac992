#pragma once

#include "sim/base/result.h"
#include "sim/film/outline.h"
#include "sim/fit/fit.h"
#include "sim/image/io/rgb_image.h"

namespace hydroprint::fit {

/// Two pictures of the film seen from above, before and after the fit. They show its outline, the
/// measured points (grey: left out, red: outliers) and from each an arrow to its prediction. The
/// title states the factor by which arrows are enlarged. About 1600 pixels wide. Fails if
/// text::Font::standard() fails.
[[nodiscard]] Result<image::RgbImage> residual_picture(const film::Outline& outline,
                                                       const Outcome& outcome);

}  // namespace hydroprint::fit
