#include "hardware/depth_camera/frame_watch.h"

#include <algorithm>

namespace hydroprint::depth_camera {

Status FrameWatch::look(const DepthFrame& frame) {
  const auto measured =
      frame.depth_mm.size() -
      static_cast<std::size_t>(std::count(frame.depth_mm.begin(), frame.depth_mm.end(), 0));
  const double share = static_cast<double>(measured) /
                       static_cast<double>(std::max<std::size_t>(1, frame.depth_mm.size()));
  black_ = share < kLeastMeasured ? black_ + 1 : 0;
  same_ = black_ == 0 && frame.depth_mm == before_ ? same_ + 1 : 0;
  before_ = frame.depth_mm;
  if (black_ >= kMostBad) {
    return fail(
        Code::kUnavailable,
        name_ +
            ": the camera measures nothing. Remove its cover, keep objects at least 0.5 m away and "
            "shade it from the sun",
        ErrorReason::CAMERA_BLACK);
  }
  if (same_ >= kMostBad) {
    return fail(Code::kUnavailable,
                name_ +
                    ": the camera is frozen: it repeats the same frame. Unplug it and plug it in "
                    "again",
                ErrorReason::CAMERA_FROZEN);
  }
  return {};
}

}  // namespace hydroprint::depth_camera
