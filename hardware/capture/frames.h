#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "hardware/capture/options.h"
#include "hardware/depth_camera/depth_camera.h"
#include "sim/base/context.h"

namespace hydroprint::capture {

/// A series of captured frames.
struct CapturedFrames {
  std::vector<depth_camera::DepthFrame> frames;
  int lost = 0;      ///< frames counted by the camera but never received
  int left_out = 0;  ///< black frames, and frames identical to the previous one
};

/// Returns the next frame, waiting at most Options::patience_s; calls `alive` repeatedly while it
/// waits. Returns nullopt at the end of a recording. Errors: those of DepthCamera::next, and
/// kCancelled.
[[nodiscard]] Result<std::optional<depth_camera::DepthFrame>> next_frame(
    depth_camera::DepthCamera& camera, const Options& options, const Context& context,
    const std::function<void()>& alive);

/// Captures frames for Options::seconds, or until the recording ends. Errors: those of next_frame()
/// and FrameWatch.
[[nodiscard]] Result<CapturedFrames> take_frames(depth_camera::DepthCamera& camera,
                                                 const Options& options, const Context& context,
                                                 const std::function<void()>& alive);

}  // namespace hydroprint::capture
