#pragma once

#include <cstddef>
#include <vector>

namespace hydroprint::scan {

/// One depth image as a camera reports it, row after row from the top left. The depth is along the
/// camera's axis, not along the pixel's ray.
struct DepthFrame {
  int width_px = 0;
  int height_px = 0;
  std::vector<float> depth_mm;  ///< width times height; 0 where there is none

  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width_px) +
           static_cast<std::size_t>(u);
  }
};

}  // namespace hydroprint::scan
