#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "sim/base/context.h"
#include "sim/scan/depth_steps.h"
#include "sim/scan/frame.h"
#include "sim/scan/noise.h"

namespace hydroprint::scan {

/// Many frames of a camera that stands still, as one.
struct FusedFrame {
  DepthFrame mean;              ///< 0 where fewer than half of the frames had a depth
  std::vector<float> sigma_mm;  ///< standard error of that mean by what changes between frames
  std::vector<std::uint16_t> frames;  ///< that the mean was taken of
};

/// Mean depth per pixel of what lies within four standard deviations of the median, where at least
/// half of the frames have a depth. A mean, not a median: depth comes in steps as large as its
/// noise, and only a mean sees between them. Where the frames tell the camera's steps
/// (find_depth_steps), their rounding to whole mm is taken back first.
/// Refuses (kInvalidArgument) no frames, more than 65535, and frames that differ in size; with
/// kFailedPrecondition and a reason: CAMERA_BLACK where hardly a pixel has a depth, CAMERA_FROZEN
/// where all of several frames are the same bit by bit, CAMERA_MOVED where depths vary far beyond
/// the noise.
[[nodiscard]] Result<FusedFrame> fuse(std::span<const DepthFrame> frames, const DepthNoise& noise,
                                      const Context& context);
/// The same, where the camera's steps are known from more frames than these.
/// @param steps  nothing: depths are taken as they are reported
[[nodiscard]] Result<FusedFrame> fuse(std::span<const DepthFrame> frames, const DepthNoise& noise,
                                      const std::optional<DepthSteps>& steps,
                                      const Context& context);

}  // namespace hydroprint::scan
