#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hardware/depth_camera/depth_frame.h"
#include "sim/base/result.h"

namespace hydroprint::depth_camera {

/// Detects a camera whose frames are useless. A few such frames are not an error, because a camera
/// may deliver some while it warms up.
class FrameWatch {
 public:
  /// Number of consecutive bad frames that counts as an error (a third of a second at 30 frames/s).
  static constexpr int kMostBad = 10;
  /// Frames with a smaller fraction of measured pixels count as black.
  static constexpr double kLeastMeasured = 0.01;

  explicit FrameWatch(std::string name) : name_(std::move(name)) {}

  /// Checks a frame. Returns kUnavailable after kMostBad consecutive bad frames: CAMERA_FROZEN
  /// (identical to the previous frame, which sensor noise rules out in a working camera) or
  /// CAMERA_BLACK.
  [[nodiscard]] Status look(const DepthFrame& frame);

  /// Returns whether the last frame checked is usable.
  [[nodiscard]] bool good() const { return same_ == 0 && black_ == 0; }

 private:
  std::string name_;
  std::vector<std::uint16_t> before_;
  int same_ = 0;
  int black_ = 0;
};

}  // namespace hydroprint::depth_camera
