#pragma once

#include <cstdint>

#include "hardware/depth_scene/scenery.h"

namespace hydroprint::depth_scene {

/// The camera's pose X_FC at a time: takes camera coordinates (x to the right of its image, y down,
/// z forward along its axis, mm) to F. Smooth; the same for the same stand, seed and time.
[[nodiscard]] Pose camera_pose(const CameraStand& stand, std::uint64_t seed, double time_s);

}  // namespace hydroprint::depth_scene
