#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

#include "hardware/simulator/drive/scene.h"

namespace hydroprint::simulated_drive {

/// What the camera of the rig is told when it looks; it draws its frames itself, in whatever
/// process it is open. Any thread may call.
class CameraControl {
 public:
  explicit CameraControl(const Scene& scene) : scene_(scene) {}

  /// What there is to see, as one line of JSON (simulated_scene::scenery_of). Refuses what the
  /// scene's scenery_of refuses.
  [[nodiscard]] Result<std::string> scenery_json();

  /// What of it changes (simulated_scene::sight_of), with the carriage at `x_mm`.
  [[nodiscard]] std::string sight_json(double time_s, double x_mm);

  void set(simulated_scene::CameraState state);
  /// Refuses (kInvalidArgument) a name that no marker has.
  [[nodiscard]] Status set(const std::string& marker, simulated_scene::MarkerState state);
  /// The marker stands so much farther, for whoever looks anew. Refuses as above.
  [[nodiscard]] Status push(const std::string& marker, const Eigen::Vector2d& by_mm);
  /// The object hangs otherwise from now on, for whoever looks anew: as the pose file says, in
  /// place of the scene's, and with a mesh (in mm) another one does. Refuses what read_pose_file
  /// and scenery_of refuse.
  [[nodiscard]] Status hang(const std::filesystem::path& pose, const std::filesystem::path& mesh);
  /// Whoever looks anew sees this mesh (in mm) alone, held where the pose file says in the camera's
  /// frame (x to the right of its image, y down, z forward): a calibration board. Without names the
  /// rig again. Refuses as `hang` does.
  [[nodiscard]] Status show(const std::filesystem::path& pose, const std::filesystem::path& mesh);
  /// All well again.
  void clear();

 private:
  [[nodiscard]] Result<std::size_t> index_of(const std::string& marker) const;

  std::mutex mutex_;
  Scene scene_;
  std::optional<std::string> scenery_;  // once asked for; while something is shown, that
  simulated_scene::Sight sight_;
};

}  // namespace hydroprint::simulated_drive
