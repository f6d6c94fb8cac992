#pragma once

#include <span>

#include "sim/base/result.h"
#include "sim/scan/frame.h"

namespace hydroprint::scan {

/// Fails (kInvalidArgument) if there are no frames or more than 65535, or if they differ in size.
/// Fails (kFailedPrecondition, CAMERA_FROZEN) if several frames are all identical.
[[nodiscard]] Status check_frames(std::span<const DepthFrame> frames);

}  // namespace hydroprint::scan
