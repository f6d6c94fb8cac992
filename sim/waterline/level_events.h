#pragma once

#include <vector>

#include "sim/waterline/body.h"

namespace hydroprint::waterline {

/// A level at which faces meet the water all at once, or at which the waterline's speed jumps along
/// a level sharp edge.
struct LevelEvent {
  double level_mm = 0;   ///< immersion
  bool is_face = false;  ///< otherwise only edges
};

/// Returns the levels of level faces and of level sharp edges: first those of faces by decreasing
/// area, then those of edges by decreasing length. Smaller ones than 0.5 mm2 or 5 mm are ignored.
/// @param shelf_slope_rad  faces within this angle of horizontal are level
[[nodiscard]] std::vector<LevelEvent> level_events(const Body& body, double shelf_slope_rad);

}  // namespace hydroprint::waterline
