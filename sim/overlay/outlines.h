#pragma once

#include <vector>

#include "sim/overlay/overlay.h"

namespace hydroprint::overlay {

/// A simple closed curve of edges between solid and open triangles. The solid lies on its left.
struct Outline {
  std::vector<int> points;  ///< indices of points of the overlay
  double area_mm2 = 0;      ///< negative: the outline of a hole
  int parent = -1;          ///< index of the innermost outline around this one; -1: none
};

/// Returns the area of a closed curve of grid points, positive if counter-clockwise, mm2.
[[nodiscard]] double area_mm2(const std::vector<GridPoint>& points, const std::vector<int>& curve);

/// Returns the outlines of all solid triangles. Outlines may share points, but do not cross.
/// @param is_solid  for each triangle of the overlay
/// @return parents before their children
[[nodiscard]] std::vector<Outline> outlines_of(const Overlay& overlay,
                                               const std::vector<char>& is_solid);

/// The solid part of the plane.
struct Region {
  Overlay overlay;
  std::vector<char> is_solid;  ///< for each triangle
  std::vector<Outline> outlines;
};

/// Returns the region in which the winding number of group 0 is not zero.
/// @param lines  as split_at_meetings() returns them
[[nodiscard]] Region solid_region(const std::vector<GridLine>& lines);

}  // namespace hydroprint::overlay
