#pragma once

#include <cstdint>
#include <vector>

namespace hydroprint::depth_camera {

/// One frame of a depth camera.
struct DepthFrame {
  int width = 0, height = 0;
  /// Depth along the optical axis, row 0 at the top, not mirrored; 0: not measured.
  std::vector<std::uint16_t> depth_mm;
  double time_s = 0;  ///< by the camera's clock; for a recording, since its first frame
  int index = 0;      ///< counted by the camera from 1; gaps are lost frames
  /// Fields of view of the whole frame, from the manufacturer. They assume a principal point in the
  /// middle and no distortion; a calibration of the lens is more accurate.
  double horizontal_fov_rad = 0, vertical_fov_rad = 0;
};

}  // namespace hydroprint::depth_camera
