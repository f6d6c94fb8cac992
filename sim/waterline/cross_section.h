#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/waterline/slicer.h"

namespace hydroprint::waterline {

/// One closed curve of a cross-section: an outer edge of the solid (counter-clockwise) or the edge
/// of a hole in it (clockwise).
struct Loop {
  std::vector<Eigen::Vector2d> points_mm;
  bool is_hole = false;
  int parent = -1;  ///< the loop directly around it; -1: none
};

/// The union of everything solid at one immersion (the film touches the first surface that reaches
/// it, whatever lies behind): simple closed curves that do not cross.
using CrossSection = std::vector<Loop>;

/// Unites contours by winding number (anything wound round at least once is solid). Gaps narrower
/// than 0.05 mm between curves are closed; curves that enclose less than 0.001 mm2 are left out.
[[nodiscard]] CrossSection unite(const std::vector<Contour>& contours);

/// Area of a closed curve, positive if counter-clockwise, mm2.
[[nodiscard]] double signed_area(const std::vector<Eigen::Vector2d>& polygon);

/// Even-odd test of a point against several closed curves.
[[nodiscard]] bool is_inside(const CrossSection& section, const Eigen::Vector2d& point_mm);

/// Area that two regions, each given by simple curves under the even-odd rule, have in common, mm2.
[[nodiscard]] double common_area(const std::vector<std::vector<Eigen::Vector2d>>& a,
                                 const std::vector<std::vector<Eigen::Vector2d>>& b);

}  // namespace hydroprint::waterline
