#pragma once

#include <cstddef>
#include <vector>

namespace hydroprint::scan {

/// One depth image as reported by the camera, row by row from the top left. Depth is measured along
/// the optical axis, not along the pixel's ray.
struct DepthFrame {
  int width_px = 0;
  int height_px = 0;
  std::vector<float> depth_mm;  ///< width times height; 0: no depth

  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width_px) +
           static_cast<std::size_t>(u);
  }
};

}  // namespace hydroprint::scan
