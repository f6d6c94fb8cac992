#pragma once

#include <span>

#include "sim/base/result.h"
#include "sim/scan/frame.h"

namespace hydroprint::scan {

/// Refuses (kInvalidArgument) no frames, more than 65535, and frames that differ in size;
/// (kFailedPrecondition, CAMERA_FROZEN) several that are all the same bit by bit.
[[nodiscard]] Status check_frames(std::span<const DepthFrame> frames);

}  // namespace hydroprint::scan
