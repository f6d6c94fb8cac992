#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace hydroprint::waterline {

struct Waterline;

/// Film that a waterline has closed round, as a ring or a cup mouth down does: cut off from the
/// rest, it can only stretch.
struct Trap {
  double immersion_mm = 0;                             ///< at which it closes
  Eigen::Vector2d place_mm = Eigen::Vector2d::Zero();  ///< middle of the hole in the cross-section
  double area_mm2 = 0;                                 ///< of the hole, at its largest
  /// Immersion at which solid closes over it: no way out upwards for the air between. None: it is
  /// open above.
  std::optional<double> ceiling_mm;
  double air_mm3 = 0;  ///< between closing and ceiling; 0 if open above
};

/// Finds the traps of a dip by following the holes that hold film from waterline to waterline,
/// until they open again or solid has closed over them. Holes smaller than 1 mm2 are left out.
/// @param lines   the dip's waterlines
/// @param beyond  those above the end of the dip, by which air is known to be caught even if the
///                dip does not reach the ceiling; may be empty, their bounds_film too
/// @return largest hole first
[[nodiscard]] std::vector<Trap> find_traps(const std::vector<Waterline>& lines,
                                           const std::vector<Waterline>& beyond);

}  // namespace hydroprint::waterline
