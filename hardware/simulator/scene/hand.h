#pragma once

#include <cstdint>

#include "hardware/simulator/scene/scenery.h"

namespace hydroprint::simulated_scene {

/// Returns the camera's pose X_FC at a time, which transforms camera coordinates (x to the right of
/// its image, y down, z forward along the optical axis, mm) to the film frame F. Smooth and
/// deterministic for a stand, seed and time.
[[nodiscard]] Pose camera_pose(const CameraStand& stand, std::uint64_t seed, double time_s);

}  // namespace hydroprint::simulated_scene
