#pragma once

#include <span>

#include "sim/base/result.h"
#include "sim/scan/frame.h"

namespace hydroprint::scan {

/// Returns kInvalidArgument if there are no frames or more than 65535, or if they differ in size.
/// Returns kFailedPrecondition (CAMERA_FROZEN) if there are several frames and all are identical.
[[nodiscard]] Status check_frames(std::span<const DepthFrame> frames);

}  // namespace hydroprint::scan
