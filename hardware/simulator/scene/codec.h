#pragma once

#include <string>
#include <string_view>

#include "hardware/simulator/scene/scenery.h"
#include "sim/base/result.h"

namespace hydroprint::simulated_scene {

/// What there is to see, as one line of JSON that gives the very same values back.
[[nodiscard]] std::string to_json(const Scenery& scenery);
[[nodiscard]] std::string to_json(const Sight& sight);

/// The way back. Refuses with kDataLoss what is no such line, and indices out of range.
[[nodiscard]] Result<Scenery> scenery_of(std::string_view json);
[[nodiscard]] Result<Sight> sight_of(std::string_view json);

/// The words for a camera's and a marker's state.
inline constexpr std::string_view kCameraStates[] = {"well", "gone", "frozen", "black", "hung"};
inline constexpr std::string_view kMarkerStates[] = {"well", "hidden", "knocked-over"};

}  // namespace hydroprint::simulated_scene
