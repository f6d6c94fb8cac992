#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

#include "hardware/simulator/drive/scene.h"

namespace hydroprint::simulated_drive {

/// The data that the rig sends to its cameras. Each camera renders its frames itself, in any
/// process. Thread-safe.
class CameraControl {
 public:
  explicit CameraControl(const Scene& scene) : scene_(scene) {}

  /// Returns the scenery as one line of JSON, which simulated_scene::scenery_of decodes. Errors:
  /// those of scenery_of() in scene.h.
  [[nodiscard]] Result<std::string> scenery_json();

  /// Returns the variable part of the scene, with the carriage at `x_mm`, as one line of JSON,
  /// which simulated_scene::sight_of decodes.
  [[nodiscard]] std::string sight_json(double time_s, double x_mm);

  void set(simulated_scene::CameraState state);
  /// Returns kInvalidArgument if no marker has that name.
  [[nodiscard]] Status set(const std::string& marker, simulated_scene::MarkerState state);
  /// Moves the marker by this distance, for cameras that are opened later. Returns kInvalidArgument
  /// if no marker has that name.
  [[nodiscard]] Status push(const std::string& marker, const Eigen::Vector2d& by_mm);
  /// Changes the object's pose to that of the pose file, for cameras that are opened later. If a
  /// mesh (in mm) is given, also replaces the object. Errors: those of read_pose_file and
  /// scenery_of.
  [[nodiscard]] Status set_object(const std::filesystem::path& pose,
                                  const std::filesystem::path& mesh);
  /// Shows only this mesh (in mm) to cameras that are opened later, for example a calibration
  /// board. Its pose is in the camera's frame (x to the right of its image, y down, z forward). If
  /// both paths are empty, shows the rig again. Errors as for `set_object`.
  [[nodiscard]] Status show(const std::filesystem::path& pose, const std::filesystem::path& mesh);
  /// Clears all faults of the camera and the markers.
  void clear();

 private:
  [[nodiscard]] Result<std::size_t> index_of(const std::string& marker) const;

  std::mutex mutex_;
  Scene scene_;
  std::optional<std::string> scenery_;  // cached JSON; the scene of show() while that is active
  simulated_scene::Sight sight_;
};

}  // namespace hydroprint::simulated_drive
