#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "hardware/camera/depth_camera.h"
#include "hardware/capture/options.h"
#include "sim/base/context.h"

namespace hydroprint::capture {

/// Frames taken one after another.
struct Taken {
  std::vector<camera::DepthFrame> frames;
  int lost = 0;      ///< that the camera counted and that never arrived
  int left_out = 0;  ///< black ones, and ones that repeat the one before
};

/// Takes frames for as long as the options say, or until the recording ends; `alive` is called
/// again and again meanwhile. Refuses what DepthCamera::next and FrameWatch refuse, and kCancelled.
[[nodiscard]] Result<Taken> take_frames(camera::DepthCamera& camera, const Options& options,
                                        const Context& context, const std::function<void()>& alive);

}  // namespace hydroprint::capture
