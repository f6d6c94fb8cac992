#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "sim/base/context.h"
#include "sim/scan/depth_steps.h"
#include "sim/scan/frame.h"
#include "sim/scan/noise.h"

namespace hydroprint::scan {

/// Many frames of a camera that does not move, combined into one.
struct FusedFrame {
  DepthFrame mean;              ///< 0 where fewer than half of the frames had a depth
  std::vector<float> sigma_mm;  ///< standard error of the mean, from noise that differs by frame
  std::vector<std::uint16_t> frames;  ///< number of frames in the mean
};

/// Mean depth of each pixel for which at least half of the frames have a depth. Depths beyond four
/// standard deviations from the median are left out. The mean is used because depth comes in steps
/// as large as its noise; a median would always be one of the steps. If the camera's steps can be
/// found in the frames (find_depth_steps), their rounding to whole mm is undone first.
/// Fails (kInvalidArgument) if there are no frames or more than 65535, or if they differ in size.
/// Fails with kFailedPrecondition and a reason: CAMERA_BLACK if hardly any pixel has a depth,
/// CAMERA_FROZEN if several frames are all identical, CAMERA_MOVED if depths vary far more than
/// their noise.
[[nodiscard]] Result<FusedFrame> fuse(std::span<const DepthFrame> frames, const DepthNoise& noise,
                                      const Context& context);
/// Same as above, for steps that were found in a larger set of frames.
/// @param steps  nullopt: depths are used as reported
[[nodiscard]] Result<FusedFrame> fuse(std::span<const DepthFrame> frames, const DepthNoise& noise,
                                      const std::optional<DepthSteps>& steps,
                                      const Context& context);

}  // namespace hydroprint::scan
