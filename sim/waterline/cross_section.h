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
  int parent = -1;  ///< index of the innermost loop around this loop; -1: none
};

/// The union of all solid parts at one immersion, as simple closed curves that do not cross. The
/// union is used because the film sticks to the first surface that touches it.
using CrossSection = std::vector<Loop>;

/// Curves that enclose less are dropped.
inline constexpr double kLeastLoop_mm2 = 1e-3;

/// Merges contours by winding number; regions with a nonzero winding number are solid. Gaps
/// narrower than 0.3 mm between curves are closed. Curves that enclose less than kLeastLoop_mm2 are
/// dropped.
[[nodiscard]] CrossSection unite(const std::vector<Contour>& contours);

/// Returns the area of a closed curve, positive if counter-clockwise, mm2.
[[nodiscard]] double signed_area(const std::vector<Eigen::Vector2d>& polygon);

/// Returns the area of the solid, mm2.
[[nodiscard]] double area_mm2(const CrossSection& section);

/// Returns true if the point lies inside a closed curve.
[[nodiscard]] bool is_inside(const std::vector<Eigen::Vector2d>& polygon,
                             const Eigen::Vector2d& point_mm);

/// Returns true if the point lies inside the solid, by the even-odd rule.
[[nodiscard]] bool is_inside(const CrossSection& section, const Eigen::Vector2d& point_mm);

/// Returns the area of the intersection of two regions, each given by simple curves under the
/// even-odd rule, mm2.
[[nodiscard]] double common_area(const std::vector<std::vector<Eigen::Vector2d>>& a,
                                 const std::vector<std::vector<Eigen::Vector2d>>& b);

}  // namespace hydroprint::waterline
