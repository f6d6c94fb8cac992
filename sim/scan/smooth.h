#pragma once

#include "sim/base/context.h"
#include "sim/scan/frame.h"
#include "sim/scan/noise.h"

namespace hydroprint::scan {

/// Smooths the noise of a frame's surfaces, for tracking. The constant noise of a camera
/// (DepthNoise::constant_share) moves with the camera. To a tracker it looks like relief that is
/// fixed in the image and often steeper than the real surfaces, as if the camera stood still. Each
/// depth is replaced with the harmonic mean of itself and of pairs of pixels in opposite patches,
/// up to two patches away, that lie on one plane with it. Planes and edges therefore do not change.
[[nodiscard]] Result<DepthFrame> smooth(const DepthFrame& frame, const DepthNoise& noise,
                                        const Context& context);

}  // namespace hydroprint::scan
