#pragma once

#include <cstdint>
#include <vector>

namespace hydroprint::depth_camera {

/// One frame of a depth camera.
struct DepthFrame {
  int width = 0, height = 0;
  /// Depth along the camera's axis, row 0 at the top, not mirrored; 0: not measured.
  std::vector<std::uint16_t> depth_mm;
  double time_s = 0;  ///< by the camera's clock; in a recording, since its first frame
  int index = 0;      ///< the camera's own count from 1; gaps are lost frames
  /// Fields of view of the whole frame, as the manufacturer states them: principal point in the
  /// middle, no distortion. A calibration of the lens is more accurate.
  double horizontal_fov_rad = 0, vertical_fov_rad = 0;
};

}  // namespace hydroprint::depth_camera
