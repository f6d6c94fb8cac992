#pragma once

#include <vector>

namespace hydroprint::sample {

/// A point on the outline of a solid of revolution around the z axis.
struct OutlinePoint {
  double radius_mm = 0;
  double z_mm = 0;
  double arc_mm = 0;  ///< length along the outline from its start
};

/// Part of an outline, with at least one point.
using Outline = std::vector<OutlinePoint>;

/// Adds `steps` points in a straight line that ends at this radius and height.
void add_line(Outline& outline, double radius_mm, double z_mm, int steps);

/// Adds `steps` points on an arc of radius `bend_mm` whose centre has this radius and height. The
/// outline must end at the angle `from_rad`; the last point added is at `to_rad`. Angles are
/// measured from the outward direction towards up.
void add_arc(Outline& outline, double radius_mm, double z_mm, double bend_mm, double from_rad,
             double to_rad, int steps);

}  // namespace hydroprint::sample
