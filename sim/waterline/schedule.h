#pragma once

#include <cstddef>
#include <vector>

#include "sim/waterline/body.h"

namespace hydroprint::waterline {

/// Resolution of the dip, and what becomes of enclosed air.
struct ScheduleOptions {
  /// Surface wetted between two waterlines, as a width: swept area divided by waterline length. A
  /// sphere is thus divided evenly in theta. This value is for bodies with at least the surface of
  /// a sphere of radius kLarge_mm. For smaller bodies, and where the surface has a small radius of
  /// curvature in the vertical direction, it is multiplied by the ratio of the radii to the power
  /// 2/3, so that the error in mm stays about the same. It is halved where the waterline crosses
  /// creases.
  double swept_mm = 1.6;
  static constexpr double kLarge_mm = 42;
  /// Faces within this angle of horizontal touch the water all at once. Waterlines are computed
  /// just before and just after them.
  double shelf_slope_rad = 2e-3;
  /// Distance from an event (a shelf, a level edge or a change of topology) to the waterlines just
  /// before and after it.
  double event_gap_mm = 2e-3;
  /// Distance from a level edge to the first waterline after it, and from a level top edge to the
  /// last before it. Closer to it, the film would be meshed around a needle as long as the edge.
  double edge_gap_mm = 0.05;
  /// Largest number of waterlines of a dip.
  std::size_t most = 800;
  /// Immersions at which there are waterlines in any case.
  std::vector<double> added_mm;
  /// True as if the object had vents that the mesh does not show: air keeps no film out of hollows.
  bool air_escapes = false;
};

/// Immersions at which to compute waterlines.
struct Schedule {
  std::vector<double> depths_mm;  ///< increasing
  double widening = 1;  ///< factor by which steps are longer, because of ScheduleOptions::most
  /// Levels of faces and edges that have no waterlines of their own for the same reason.
  std::vector<double> left_out_mm;
};

/// Returns the immersions at which to compute waterlines, increasing, from just after first contact
/// to just before the end of the dip. They are evenly spaced in swept surface, weighted by the
/// speed of the film there, with additional ones on both sides of every level face and level sharp
/// edge. At most half of ScheduleOptions::most are for swept surface and at most three quarters in
/// all; the rest is for changes of the topology.
[[nodiscard]] Schedule schedule(const Body& body, double depth_mm,
                                const ScheduleOptions& options = {});

}  // namespace hydroprint::waterline
