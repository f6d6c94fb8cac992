#pragma once

#include <Eigen/Core>
#include <vector>

namespace hydroprint::waterline {

/// The measured horizontal motion of the object during the dip: its offset from the planned axis as
/// a function of immersion. Empty: straight down. Immersion never decreases from row to row.
struct Motion {
  struct Row {
    double time_s = 0;
    double immersion_mm = 0;
    Eigen::Vector2d offset_mm = Eigen::Vector2d::Zero();
  };
  std::vector<Row> rows;
};

}  // namespace hydroprint::waterline
