#pragma once

#include "sim/base/result.h"
#include "sim/film/outline.h"
#include "sim/fit/fit.h"
#include "sim/image/io/rgb_image.h"

namespace hydroprint::fit {

/// Two pictures of the film seen from above, before the fit and after it: its outline, the measured
/// points (grey: left out, red: outliers) and from each an arrow to where the prediction has it,
/// enlarged by a factor that stands above. About 1600 pixels wide. Fails as text::Font::standard()
/// does.
[[nodiscard]] Result<image::RgbImage> residual_picture(const film::Outline& outline,
                                                       const Outcome& outcome);

}  // namespace hydroprint::fit
