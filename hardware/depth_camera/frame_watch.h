#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hardware/depth_camera/depth_frame.h"
#include "sim/base/result.h"

namespace hydroprint::depth_camera {

/// Looks at frame after frame for a camera that still sends, but nothing of use. One or two such
/// frames are no fault: cameras warm up.
class FrameWatch {
 public:
  /// So many frames in sequence are one too many: a third of a second.
  static constexpr int kMostBad = 10;
  /// A frame with fewer measured pixels than this share is black.
  static constexpr double kLeastMeasured = 0.01;

  explicit FrameWatch(std::string name) : name_(std::move(name)) {}

  /// Refuses (kUnavailable) the frame that is the last straw: CAMERA_FROZEN, pixel for pixel the
  /// one before it, which no sensor's noise allows; CAMERA_BLACK.
  [[nodiscard]] Status look(const DepthFrame& frame);

  /// Whether the frame last looked at is worth keeping.
  [[nodiscard]] bool good() const { return same_ == 0 && black_ == 0; }

 private:
  std::string name_;
  std::vector<std::uint16_t> before_;
  int same_ = 0;
  int black_ = 0;
};

}  // namespace hydroprint::depth_camera
