#pragma once

#include "sim/base/context.h"
#include "sim/scan/frame.h"
#include "sim/scan/noise.h"

namespace hydroprint::scan {

/// A frame with the noise of its surfaces averaged out, for tracking. What a camera adds to every
/// frame alike (DepthNoise::constant_share) moves with it: to a tracker it is relief that stands
/// still in the image, on a level surface steeper than most that is really there, and holds the
/// camera where it was. A depth becomes the mean over its own patch and those up to two patches
/// away that lie, with their opposite, on one plane with it: planes stay as they are, and edges
/// where they are.
[[nodiscard]] Result<DepthFrame> smooth(const DepthFrame& frame, const DepthNoise& noise,
                                        const Context& context);

}  // namespace hydroprint::scan
