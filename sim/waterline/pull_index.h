#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/waterline/slicer.h"

namespace hydroprint::waterline {

/// Looks up the pull of eq. (1) at any point of the waterline from the nearest segment. The
/// segments of all contours at one immersion are binned on a grid.
class PullIndex {
 public:
  PullIndex() = default;
  explicit PullIndex(const std::vector<Contour>& contours);

  /// Returns the film velocity per unit of dip speed at the waterline point nearest to `point_mm`;
  /// zero if there are no segments.
  [[nodiscard]] Eigen::Vector2d at(const Eigen::Vector2d& point_mm) const;

 private:
  [[nodiscard]] Eigen::Vector2i cell_of(const Eigen::Vector2d& point_mm) const;

  std::vector<Segment> segments_;
  Eigen::Vector2d origin_mm_ = Eigen::Vector2d::Zero();
  Eigen::Vector2i cells_ = Eigen::Vector2i::Zero();
  std::vector<int> cell_start_, cell_segments_;
};

}  // namespace hydroprint::waterline
