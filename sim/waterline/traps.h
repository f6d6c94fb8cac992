#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace hydroprint::waterline {

struct Waterline;

/// Film enclosed by a waterline, for example under a ring or an upside-down cup. It is cut off from
/// the rest of the film and can only stretch.
struct Trap {
  double immersion_mm = 0;  ///< immersion at which the waterline closes around the film
  Eigen::Vector2d place_mm = Eigen::Vector2d::Zero();  ///< centre of the hole in the cross-section
  double area_mm2 = 0;                                 ///< largest area of the hole
  /// Immersion at which the solid closes above the trap, so that air cannot escape; nullopt: the
  /// trap is open above.
  std::optional<double> ceiling_mm;
  double air_mm3 = 0;  ///< volume between immersion_mm and ceiling_mm; 0 if open above
};

/// Finds the traps of a dip. Follows the holes that contain film from waterline to waterline, until
/// they open again or the solid closes above them. Holes smaller than 1 mm2 are ignored.
/// @param lines   the dip's waterlines
/// @param beyond  waterlines above the end of the dip, which show whether a ceiling that the dip
///                does not reach traps air; may be empty. Their bounds_film may be empty, too
/// @return the traps, largest hole first
[[nodiscard]] std::vector<Trap> find_traps(const std::vector<Waterline>& lines,
                                           const std::vector<Waterline>& beyond);

}  // namespace hydroprint::waterline
