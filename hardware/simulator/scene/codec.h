#pragma once

#include <string>
#include <string_view>

#include "hardware/simulator/scene/scenery.h"
#include "sim/base/result.h"

namespace hydroprint::simulated_scene {

/// Encodes a scene as one line of JSON; decoding gives identical values.
[[nodiscard]] std::string to_json(const Scenery& scenery);
[[nodiscard]] std::string to_json(const Sight& sight);

/// Decode the lines of to_json(). Errors: kDataLoss if the text is malformed or has indices out of
/// range.
[[nodiscard]] Result<Scenery> scenery_of(std::string_view json);
[[nodiscard]] Result<Sight> sight_of(std::string_view json);

/// Names of the states of cameras and markers.
inline constexpr std::string_view kCameraStates[] = {"well", "gone", "frozen", "black", "hung"};
inline constexpr std::string_view kMarkerStates[] = {"well", "hidden", "knocked-over"};

}  // namespace hydroprint::simulated_scene
