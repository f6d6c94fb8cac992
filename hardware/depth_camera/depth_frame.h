#pragma once

#include <cstdint>
#include <vector>

namespace hydroprint::depth_camera {

/// One frame of a depth camera.
struct DepthFrame {
  int width = 0, height = 0;
  /// Along the camera's axis, row 0 on top, not mirrored; 0: not measured.
  std::vector<std::uint16_t> depth_mm;
  double time_s = 0;  ///< by the camera's clock; of a recording, from its first frame
  int index = 0;      ///< the camera's own count from 1; gaps are frames lost
  /// Of the whole frame. The camera's maker's figures: the principal point counts as the frame's
  /// middle, and nothing is said of distortion; a calibration of the lens knows better.
  double horizontal_fov_rad = 0, vertical_fov_rad = 0;
};

}  // namespace hydroprint::depth_camera
