#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace hydroprint::scan {

/// The points seen by all pixels, row by row; z = 0: no point. Camera frame.
struct PointGrid {
  int width_px = 0;
  int height_px = 0;
  std::vector<Eigen::Vector3d> points;

  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width_px) +
           static_cast<std::size_t>(u);
  }
  [[nodiscard]] const Eigen::Vector3d& at(int u, int v) const { return points[index(u, v)]; }
  [[nodiscard]] bool holds(int u, int v) const {
    return u >= 0 && v >= 0 && u < width_px && v < height_px && at(u, v).z() > 0;
  }
};

}  // namespace hydroprint::scan
