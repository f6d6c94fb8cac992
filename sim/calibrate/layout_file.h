#pragma once

#include <filesystem>

#include "sim/base/result.h"
#include "sim/registration/object/object_points.h"

namespace hydroprint::calibrate {

/// What a rig looks like to its camera; film frame.
struct RigLayout {
  Pose nominal_FC = Pose::Identity();       ///< the camera's, to 30 degrees
  registration::Surroundings surroundings;  ///< with the markers' layout
};

/// Reads a rig's layout from TOML; deploy/rig_layout.toml.example has all keys. Refuses what
/// TomlReader refuses, and markers of one name.
[[nodiscard]] Result<RigLayout> read_layout(const std::filesystem::path& path);

}  // namespace hydroprint::calibrate
