#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace hydroprint::waterline {

struct Waterline;

/// Film enclosed by a waterline, as under a ring or a cup with its mouth down. It is cut off from
/// the rest of the film and can only stretch.
struct Trap {
  double immersion_mm = 0;                             ///< at which it closes
  Eigen::Vector2d place_mm = Eigen::Vector2d::Zero();  ///< middle of the hole in the cross-section
  double area_mm2 = 0;                                 ///< largest area of the hole
  /// Immersion at which the solid closes above it, so that air cannot escape; nullopt: it is open
  /// above.
  std::optional<double> ceiling_mm;
  double air_mm3 = 0;  ///< between closing and ceiling; 0 if open above
};

/// Finds the traps of a dip. Follows the holes that contain film from waterline to waterline, until
/// they open again or the solid closes above them. Holes smaller than 1 mm2 are left out.
/// @param lines   the dip's waterlines
/// @param beyond  waterlines above the end of the dip, which show if air is caught by a ceiling
///                that the dip does not reach; may be empty, and so may their bounds_film
/// @return the traps, largest hole first
[[nodiscard]] std::vector<Trap> find_traps(const std::vector<Waterline>& lines,
                                           const std::vector<Waterline>& beyond);

}  // namespace hydroprint::waterline
