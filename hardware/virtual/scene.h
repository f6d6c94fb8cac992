#pragma once

#include <filesystem>

#include "sim/base/pose.h"
#include "sim/base/result.h"

namespace hydroprint::virtual_rig {

/// What hangs in the gripper, and where the axis and the water are.
struct Scene {
  std::filesystem::path mesh;  ///< empty: nothing hangs there
  double scale = 1;            ///< model units -> mm
  /// How crookedly it hangs: takes object coordinates to the gripper's frame, whose origin is where
  /// the gripper holds, z up.
  Pose X_GO = Pose::Identity();
  double travel_mm = 300;
  double start_mm = 50;   ///< where the carriage stands when the rig is switched on
  double water_mm = 200;  ///< axis position at which the gripper's origin is level with the water
};

/// Reads and checks a scene file (hardware/virtual/scene.toml.example); all keys are optional.
/// Refuses, naming file, line and remedy, unknown keys, wrong types, values out of range, and a
/// mesh or a pose file that cannot be used. Relative paths start at the file's own folder.
[[nodiscard]] Result<Scene> read_scene(const std::filesystem::path& path);

}  // namespace hydroprint::virtual_rig
