#pragma once

#include "hardware/simulator/scene/scenery.h"

namespace hydroprint::simulated_scene {

/// Width of the sliding bars round the film and height of their tops, which the markers stand on,
/// over the water, mm.
inline constexpr double kBarWidth_mm = 60;
inline constexpr double kBarTop_mm = 10;

/// The four markers as the rig is meant to have them: one on each bar, so placed that no turn takes
/// them into each other.
[[nodiscard]] std::vector<Marker> nominal_markers(const Eigen::Vector2d& film_mm);

/// Table, vat, water (level z = 0) and the four bars round a film of that size, F.
[[nodiscard]] std::vector<Body> standing_bodies(const Eigen::Vector2d& film_mm);

/// The gripper and its rod, G.
[[nodiscard]] Body gripper();

}  // namespace hydroprint::simulated_scene
