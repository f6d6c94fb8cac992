#pragma once

#include <functional>

#include "hardware/capture/options.h"
#include "hardware/depth_camera/depth_camera.h"
#include "sim/base/context.h"

namespace hydroprint::capture {

/// Writes what the camera sees to a descriptor, one picture every `every_s` of the options: a line
/// of JSON (bytes, width, height, nearest_mm, farthest_mm, measured_share, camera) and as many
/// bytes of PNG. Goes on until it is cancelled. Refuses what next_frame() and FrameWatch refuse,
/// and (kUnavailable) a reader that left.
[[nodiscard]] Status show_live(depth_camera::DepthCamera& camera, const Options& options,
                               const Context& context, const std::function<void()>& alive, int to);

}  // namespace hydroprint::capture
