#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <vector>

#include "hardware/simulator/scene/scenery.h"
#include "sim/base/pose.h"
#include "sim/base/result.h"

namespace hydroprint::simulated_drive {

/// The depth camera over the rig.
struct Camera {
  simulated_scene::CameraStand stand;
  std::uint64_t seed = 1;
  bool has_errors = true;
  bool counts_frames = false;
};

/// What hangs in the gripper, where the axis and the water are, and what a camera sees of it.
struct Scene {
  std::filesystem::path mesh;  ///< empty: nothing hangs there
  double scale = 1;            ///< model units -> mm
  /// How crookedly it hangs: takes object coordinates to the gripper's frame, whose origin is where
  /// the gripper holds, z up.
  Pose X_GO = Pose::Identity();
  double travel_mm = 300;
  double start_mm = 50;   ///< where the carriage stands when the rig is switched on
  double water_mm = 200;  ///< axis position at which the gripper's origin is level with the water
  Eigen::Vector2d film_mm{210, 297};             ///< that the sliding bars are set to
  std::vector<simulated_scene::Marker> markers;  ///< where they truly stand
  std::optional<Camera> camera;                  ///< none: there is no camera
};

/// Reads and checks a scene file (hardware/simulator/drive/scene.toml.example); all keys are
/// optional. Refuses, naming file, line and remedy, unknown keys, wrong types, values out of range,
/// and a mesh or a pose file that cannot be used. Relative paths start at the file's own folder.
[[nodiscard]] Result<Scene> read_scene(const std::filesystem::path& path);

/// All that the scene's camera could see: the object's mesh is read for it. Refuses what
/// mesh::read_model refuses, and a scene without a camera (kNotFound).
[[nodiscard]] Result<simulated_scene::Scenery> scenery_of(const Scene& scene);

}  // namespace hydroprint::simulated_drive
