#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "sim/base/context.h"
#include "sim/scan/depth_steps.h"
#include "sim/scan/frame.h"
#include "sim/scan/noise.h"

namespace hydroprint::scan {

/// Several frames of a stationary camera, combined into one.
struct FusedFrame {
  DepthFrame mean;  ///< 0 where fewer than half of the frames had a depth
  /// Standard error of the mean, from the noise that differs between frames.
  std::vector<float> sigma_mm;
  std::vector<std::uint16_t> frames;  ///< number of frames in the mean
};

/// Computes the mean depth of each pixel for which at least half of the frames have a depth. Depths
/// beyond four standard deviations from the median are ignored. Uses the mean because depth is
/// quantised in steps as large as its noise, and a median would always be one of the steps. If the
/// camera's steps can be found in the frames (find_depth_steps), the rounding of depths to whole mm
/// is undone first. Returns kInvalidArgument if there are no frames or more than 65535, or if they
/// differ in size. Returns kFailedPrecondition with a reason: CAMERA_BLACK if hardly any pixel has
/// a depth, CAMERA_FROZEN if there are several frames and all are identical, CAMERA_MOVED if depths
/// vary far more than their noise.
[[nodiscard]] Result<FusedFrame> fuse(std::span<const DepthFrame> frames, const DepthNoise& noise,
                                      const Context& context);
/// Same as above, with steps that were found in a larger set of frames.
/// @param steps  nullopt: depths are used as reported
[[nodiscard]] Result<FusedFrame> fuse(std::span<const DepthFrame> frames, const DepthNoise& noise,
                                      const std::optional<DepthSteps>& steps,
                                      const Context& context);

}  // namespace hydroprint::scan
