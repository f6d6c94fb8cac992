#include "sim/scan/check_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace hydroprint::scan {

Status check_frames(std::span<const DepthFrame> frames) {
  if (frames.empty())
    return fail(Code::kInvalidArgument,
                "no depth frames were recorded. Check the camera, and record again");
  if (frames.size() > std::numeric_limits<std::uint16_t>::max())
    return fail(Code::kInvalidArgument, "more than 65535 depth frames. Use fewer frames");
  const DepthFrame& first = frames.front();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const DepthFrame& frame = frames[i];
    if (frame.width_px <= 0 || frame.width_px != first.width_px ||
        frame.height_px != first.height_px ||
        frame.depth_mm.size() != frame.index(0, frame.height_px))
      return fail(Code::kInvalidArgument,
                  fmt::format("the size of depth frame {} is invalid or differs from the first. "
                              "Record all frames in the same camera mode",
                              i));
  }
  const auto is_nothing = [](float depth_mm) { return depth_mm == 0; };
  if (std::all_of(first.depth_mm.begin(), first.depth_mm.end(), is_nothing))
    return {};  // callers report CAMERA_BLACK
  const auto same = [&](const DepthFrame& frame) { return frame.depth_mm == first.depth_mm; };
  if (frames.size() > 1 && std::all_of(frames.begin() + 1, frames.end(), same))
    return fail(
        Code::kFailedPrecondition,
        fmt::format("all {} depth frames are identical, so the camera is frozen. Reconnect it",
                    frames.size()),
        ErrorReason::CAMERA_FROZEN);
  return {};
}

}  // namespace hydroprint::scan
