#pragma once

#include <vector>

#include "sim/registration/film_frame/film_frame.h"

namespace hydroprint::registration {

/// What of a scan cannot be the object; film frame.
struct Surroundings {
  double clear_mm = 16;  ///< points lower than this over the water are water's, film's or bars'
  /// The gripper: all within an upright cylinder, from this height on.
  Eigen::Vector2d gripper_mm = Eigen::Vector2d::Zero();
  double gripper_radius_mm = 28;
  double gripper_from_mm = 1e9;  ///< none
  /// Where the object may be: within this of the film's centre in x and in y.
  Eigen::Vector2d reach_mm{140, 180};
  MarkerLayout layout;  ///< as find_film_frame() was given it
};

/// What of a scan may be the object.
struct ObjectPoints {
  std::vector<scan::ScanPoint> all;  ///< without specks; the largest connected piece first
  std::size_t largest = 0;           ///< how many that piece has
};

/// @param frame  its markers are left out, and what lies round the places of those that are not
///               where they should be
[[nodiscard]] ObjectPoints object_points(const scan::Cloud& cloud, const FilmFrame& frame,
                                         const Surroundings& surroundings);

}  // namespace hydroprint::registration
