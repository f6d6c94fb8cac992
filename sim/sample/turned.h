#pragma once

#include <vector>

namespace hydroprint::sample {

/// A place on the outline of a body turned round the z axis.
struct OutlinePoint {
  double radius_mm = 0;
  double z_mm = 0;
  double arc_mm = 0;  ///< along the outline from where it begins
};

/// A stretch of outline that has a first point, and grows.
using Outline = std::vector<OutlinePoint>;

/// Adds `steps` points, the last of them at this radius and height, in a straight line.
void add_line(Outline& outline, double radius_mm, double z_mm, int steps);

/// Adds `steps` points on a circle of radius `bend_mm` round a place of this radius and height: the
/// last at angle `to_rad`, the one before the first at `from_rad`, where the outline ends. Angles
/// run from outward to up.
void add_arc(Outline& outline, double radius_mm, double z_mm, double bend_mm, double from_rad,
             double to_rad, int steps);

}  // namespace hydroprint::sample
