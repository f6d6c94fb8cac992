#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "hardware/capture/options.h"
#include "hardware/depth_camera/depth_camera.h"
#include "sim/base/context.h"

namespace hydroprint::capture {

/// Frames taken one after another.
struct Taken {
  std::vector<depth_camera::DepthFrame> frames;
  int lost = 0;      ///< that the camera counted and that never arrived
  int left_out = 0;  ///< black ones, and ones that repeat the one before
};

/// The next frame, within the patience of the options; `alive` is called again and again meanwhile.
/// None: the recording has ended. Refuses what DepthCamera::next refuses, and kCancelled.
[[nodiscard]] Result<std::optional<depth_camera::DepthFrame>> next_frame(
    depth_camera::DepthCamera& camera, const Options& options, const Context& context,
    const std::function<void()>& alive);

/// Takes frames for as long as the options say, or until the recording ends. Refuses what
/// next_frame() and FrameWatch refuse.
[[nodiscard]] Result<Taken> take_frames(depth_camera::DepthCamera& camera, const Options& options,
                                        const Context& context, const std::function<void()>& alive);

}  // namespace hydroprint::capture
