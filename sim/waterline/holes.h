#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "sim/waterline/cross_section.h"

namespace hydroprint::waterline {

/// A hole of a cross-section, without the islands in it.
struct Hole {
  std::size_t loop = 0;                              ///< index of its edge in the cross-section
  std::vector<std::vector<Eigen::Vector2d>> curves;  ///< its edge and those of the islands in it
  double area_mm2 = 0;
  Eigen::AlignedBox2d box_mm;
};

/// Returns the holes of a cross-section, in the order of their loops.
[[nodiscard]] std::vector<Hole> holes_of(const CrossSection& section);

/// Returns the area that two holes share when seen from above, mm2.
[[nodiscard]] double common_area(const Hole& a, const Hole& b);

}  // namespace hydroprint::waterline
