#pragma once

#include <Eigen/Core>
#include <vector>

namespace hydroprint::waterline {

/// How the object strays sideways on its way down, as driven: offset from the planned axis against
/// immersion. Empty: straight down. Rows in order of immersion, which never decreases.
struct Motion {
  struct Row {
    double time_s = 0;
    double immersion_mm = 0;
    Eigen::Vector2d offset_mm = Eigen::Vector2d::Zero();
  };
  std::vector<Row> rows;
};

}  // namespace hydroprint::waterline
