#pragma once

#include <filesystem>

#include "sim/base/result.h"
#include "sim/registration/object/object_points.h"

namespace hydroprint::calibrate {

/// The parts of a rig that its camera sees; film frame.
struct RigLayout {
  Pose nominal_FC = Pose::Identity();       ///< pose of the camera, accurate to 30 degrees
  registration::Surroundings surroundings;  ///< includes the layout of the markers
};

/// Reads a rig's layout from TOML; deploy/rig_layout.toml.example describes all keys. Returns the
/// errors of TomlReader, and an error if two markers have the same name.
[[nodiscard]] Result<RigLayout> read_layout(const std::filesystem::path& path);

}  // namespace hydroprint::calibrate
