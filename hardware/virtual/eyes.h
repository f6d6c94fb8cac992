#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

#include "hardware/virtual/scene.h"

namespace hydroprint::virtual_rig {

/// What the camera of the rig is told when it looks; it draws its frames itself, in whatever
/// process it is open. Any thread may call.
class Eyes {
 public:
  explicit Eyes(const Scene& scene) : scene_(scene) {}

  /// What there is to see, as one line of JSON (depth_scene::scenery_of). Refuses what the scene's
  /// scenery_of refuses.
  [[nodiscard]] Result<std::string> scenery_json();

  /// What of it changes (depth_scene::sight_of), with the carriage at `x_mm`.
  [[nodiscard]] std::string sight_json(double time_s, double x_mm);

  void set(depth_scene::CameraState state);
  /// Refuses (kInvalidArgument) a name that no marker has.
  [[nodiscard]] Status set(const std::string& marker, depth_scene::MarkerState state);
  /// The object hangs otherwise from now on, for whoever looks anew: as the pose file says, in
  /// place of the scene's. Refuses what read_pose_file refuses.
  [[nodiscard]] Status hang(const std::filesystem::path& pose);
  /// All well again.
  void clear();

 private:
  std::mutex mutex_;
  Scene scene_;
  std::optional<std::string> scenery_;  // once asked for
  depth_scene::Sight sight_;
};

}  // namespace hydroprint::virtual_rig
