#pragma once

#include <filesystem>

#include "sim/base/result.h"
#include "sim/registration/object/object_points.h"

namespace hydroprint::calibrate {

/// A rig as seen by its camera; film frame.
struct RigLayout {
  Pose nominal_FC = Pose::Identity();       ///< of the camera, accurate to 30 degrees
  registration::Surroundings surroundings;  ///< with the markers' layout
};

/// Reads a rig's layout from TOML; deploy/rig_layout.toml.example has all keys. Fails as TomlReader
/// does, and if two markers have the same name.
[[nodiscard]] Result<RigLayout> read_layout(const std::filesystem::path& path);

}  // namespace hydroprint::calibrate
