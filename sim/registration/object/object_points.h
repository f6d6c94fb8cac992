#pragma once

#include <limits>
#include <vector>

#include "sim/registration/film_frame/film_frame.h"

namespace hydroprint::registration {

/// Parts of a scan that cannot belong to the object; film frame.
struct Surroundings {
  double clear_mm = 16;  ///< points below this height above the water are water, film or bars
  /// Position (x, y) of the axis of the vertical cylinder that contains the gripper.
  Eigen::Vector2d gripper_mm = Eigen::Vector2d::Zero();
  double gripper_radius_mm = 28;
  /// Height of the gripper's lower end; default: no gripper.
  double gripper_from_mm = std::numeric_limits<double>::infinity();
  /// The object is within this distance of the film's centre in x and in y.
  Eigen::Vector2d reach_mm{140, 180};
  MarkerLayout layout;  ///< the layout passed to find_film_frame()
};

/// The points of a scan that may belong to the object.
struct ObjectPoints {
  /// Without isolated specks; the largest connected piece comes first.
  std::vector<scan::ScanPoint> all;
  std::size_t largest = 0;  ///< number of points in that piece
};

/// Selects the points that may belong to the object.
/// @param frame  points at its markers are dropped, with a wider margin around markers that were
/// not
///               used, because these may be displaced
[[nodiscard]] ObjectPoints object_points(const scan::Cloud& cloud, const FilmFrame& frame,
                                         const Surroundings& surroundings);

}  // namespace hydroprint::registration
