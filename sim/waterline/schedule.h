#pragma once

#include <vector>

#include "sim/waterline/body.h"

namespace hydroprint::waterline {

/// How finely the dip is divided.
struct ScheduleOptions {
  /// Surface wetted between two waterlines, as a width: swept area over waterline length. A sphere
  /// is thus divided evenly in theta. This for bodies with at least the surface of a sphere of
  /// radius kLarge_mm; less, by the power 2/3 of that radius, for smaller ones, and likewise where
  /// the surface bends sharply as it comes up, so that the error in mm stays about the same; half
  /// as much where the waterline crosses creases.
  double swept_mm = 3.2;
  static constexpr double kLarge_mm = 42;
  /// Faces nearer than this to parallel with the water touch it all at once: the dip is divided
  /// just before and just after them.
  double shelf_slope_rad = 2e-3;
  /// How far before and after an event (a shelf, a level edge, a change of topology) the waterlines
  /// on its two sides are taken.
  double event_gap_mm = 2e-3;
};

/// Immersions at which to take waterlines, from just after first contact to just before the top,
/// increasing: evenly in swept surface (weighed by how fast the film moves there), and on both
/// sides of every level face and level sharp edge.
[[nodiscard]] std::vector<double> schedule(const Body& body, double depth_mm,
                                           const ScheduleOptions& options = {});

}  // namespace hydroprint::waterline
