#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace hydroprint::waterline {

struct Waterline;

/// Film enclosed by a waterline, for example under a ring or an upside-down cup. It is cut off from
/// the rest of the film and can only stretch.
struct Trap {
  double immersion_mm = 0;                             ///< immersion at which it closes
  Eigen::Vector2d place_mm = Eigen::Vector2d::Zero();  ///< centre of the hole in the cross-section
  double area_mm2 = 0;                                 ///< largest area of the hole
  /// Immersion at which the solid closes above it, so that air cannot escape; nullopt: it is open
  /// above.
  std::optional<double> ceiling_mm;
  double air_mm3 = 0;  ///< between closing and ceiling; 0 if open above
};

/// Finds the traps of a dip. Follows the holes that contain film from waterline to waterline, until
/// they open again or the solid closes above them. Holes smaller than 1 mm2 are ignored.
/// @param lines   the dip's waterlines
/// @param beyond  waterlines above the end of the dip. They show whether a ceiling that the dip
///                does not reach traps air. May be empty, and so may their bounds_film
/// @return the traps, largest hole first
[[nodiscard]] std::vector<Trap> find_traps(const std::vector<Waterline>& lines,
                                           const std::vector<Waterline>& beyond);

}  // namespace hydroprint::waterline
