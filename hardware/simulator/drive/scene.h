#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <vector>

#include "hardware/simulator/scene/scenery.h"
#include "sim/base/pose.h"
#include "sim/base/result.h"

namespace hydroprint::simulated_drive {

/// The depth camera above the rig.
struct Camera {
  simulated_scene::CameraStand stand;
  std::uint64_t seed = 1;
  bool has_errors = true;
  bool counts_frames = false;
};

/// The object in the gripper, the positions of axis and water, and the view of the camera.
struct Scene {
  std::filesystem::path mesh;  ///< empty: no object
  double scale = 1;            ///< model units -> mm
  /// Pose of the object: transforms object coordinates to the gripper frame, whose origin is the
  /// gripping point, z up.
  Pose X_GO = Pose::Identity();
  double travel_mm = 300;
  double start_mm = 50;   ///< position of the carriage when the rig is switched on
  double water_mm = 200;  ///< axis position at which the gripper's origin is level with the water
  Eigen::Vector2d film_mm{210, 297};             ///< film size to which the sliding bars are set
  std::vector<simulated_scene::Marker> markers;  ///< at their true positions
  std::optional<Camera> camera;                  ///< nullopt: no camera
};

/// Reads and validates a scene file (hardware/simulator/drive/scene.toml.example); all keys are
/// optional. Errors name file, line and remedy. They cover unknown keys, wrong types, values out of
/// range, and an unusable mesh or pose file. Relative paths are relative to the scene file's
/// folder.
[[nodiscard]] Result<Scene> read_scene(const std::filesystem::path& path);

/// Returns everything that the scene's camera can see. Reads the object's mesh. Errors: those of
/// mesh::read_model, and kNotFound if the scene has no camera.
[[nodiscard]] Result<simulated_scene::Scenery> scenery_of(const Scene& scene);

}  // namespace hydroprint::simulated_drive
