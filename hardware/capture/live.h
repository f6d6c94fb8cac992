#pragma once

#include <functional>

#include "hardware/capture/options.h"
#include "hardware/depth_camera/depth_camera.h"
#include "sim/base/context.h"

namespace hydroprint::capture {

/// Writes a picture to the descriptor `to` every Options::every_s: one line of JSON (bytes, width,
/// height, nearest_mm, farthest_mm, measured_share, camera), followed by a PNG file of `bytes`
/// bytes. Runs until it is cancelled. Errors: those of next_frame() and FrameWatch, and
/// kUnavailable if the reader has closed the connection.
[[nodiscard]] Status show_live(depth_camera::DepthCamera& camera, const Options& options,
                               const Context& context, const std::function<void()>& alive, int to);

}  // namespace hydroprint::capture
