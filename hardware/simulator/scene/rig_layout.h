#pragma once

#include "hardware/simulator/scene/scenery.h"

namespace hydroprint::simulated_scene {

/// Width of the sliding bars around the film, and height of their tops above the water, mm. The
/// markers stand on the tops.
inline constexpr double kBarWidth_mm = 60;
inline constexpr double kBarTop_mm = 10;

/// Returns the nominal positions of the four markers: one on each bar, placed so that no rotation
/// maps them onto each other.
[[nodiscard]] std::vector<Marker> nominal_markers(const Eigen::Vector2d& film_mm);

/// Returns table, vat, water (level z = 0) and the four bars around a film of that size, in the
/// film frame F.
[[nodiscard]] std::vector<Body> standing_bodies(const Eigen::Vector2d& film_mm);

/// Returns the gripper and its rod, in the gripper frame G.
[[nodiscard]] Body gripper();

}  // namespace hydroprint::simulated_scene
