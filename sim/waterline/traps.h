#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "sim/waterline/holes.h"

namespace hydroprint::waterline {

struct Waterline;

/// Trapped air at one waterline.
struct AirSection {
  double immersion_mm = 0;
  Hole hole;
};

/// Film enclosed by a waterline, for example under a ring or an upside-down cup. It is cut off from
/// the rest of the film and can only stretch. If the air above it cannot escape, water and film
/// stay where the waterline closed around them.
struct Trap {
  double immersion_mm = 0;  ///< immersion at which the waterline closes around the film
  Eigen::Vector2d place_mm = Eigen::Vector2d::Zero();  ///< centre of the hole in the cross-section
  double area_mm2 = 0;                                 ///< largest area of the film in the hole
  /// Immersion at which the solid closes above the trap, so that air cannot escape; nullopt: the
  /// trap is open above, or its air joins that of another trap.
  std::optional<double> ceiling_mm;
  double air_mm3 = 0;           ///< volume of the air that cannot escape
  std::vector<AirSection> air;  ///< its sections by increasing immersion; empty without a ceiling
};

/// Returns whether a point lies in the trapped air. Between two waterlines, the air is taken to
/// fill the sections at both.
/// @param point_mm  in F, where the water meets it; z is the immersion
[[nodiscard]] bool is_in_air(const Trap& trap, const Eigen::Vector3d& point_mm);

/// Finds the traps of a dip. Follows the holes that contain film from waterline to waterline, until
/// they open again or the solid closes above them. Holes smaller than 1 mm2 are ignored.
/// @param lines      the dip's waterlines, with the film that they would bound if all air could
///                   escape, and those above the end of the dip, whose bounds_film may be empty
/// @param is_closed  for each of them, see holes_with_trapped_air()
/// @param count      number of waterlines of the dip
/// @return the traps, largest first
[[nodiscard]] std::vector<Trap> find_traps(const std::vector<const Waterline*>& lines,
                                           const std::vector<std::vector<char>>& is_closed,
                                           std::size_t count);

}  // namespace hydroprint::waterline
