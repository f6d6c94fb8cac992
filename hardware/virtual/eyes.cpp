#include "hardware/virtual/eyes.h"

#include "hardware/depth_scene/codec.h"
#include "sim/base/pose_file.h"

namespace hydroprint::virtual_rig {

Result<std::string> Eyes::scenery_json() {
  const std::scoped_lock lock(mutex_);
  if (!scenery_) {
    HP_ASSIGN_OR_RETURN(const depth_scene::Scenery scenery, scenery_of(scene_));
    scenery_ = depth_scene::to_json(scenery);
  }
  return *scenery_;
}

std::string Eyes::sight_json(double time_s, double x_mm) {
  const std::scoped_lock lock(mutex_);
  sight_.time_s = time_s;
  sight_.gripper_height_mm = scene_.water_mm - x_mm;
  return depth_scene::to_json(sight_);
}

void Eyes::set(depth_scene::CameraState state) {
  const std::scoped_lock lock(mutex_);
  sight_.camera = state;
}

Status Eyes::set(const std::string& marker, depth_scene::MarkerState state) {
  const std::scoped_lock lock(mutex_);
  std::string names;
  for (std::size_t i = 0; i < scene_.markers.size(); ++i) {
    names += (names.empty() ? "" : ", ") + scene_.markers[i].name;
    if (scene_.markers[i].name != marker) continue;
    sight_.markers.resize(scene_.markers.size(), depth_scene::MarkerState::kWell);
    sight_.markers[i] = state;
    return {};
  }
  return fail(Code::kInvalidArgument, "no marker is called \"" + marker.substr(0, 40) +
                                          "\". Name one of " +
                                          (names.empty() ? "a --scene's" : names));
}

Status Eyes::hang(const std::filesystem::path& pose) {
  HP_ASSIGN_OR_RETURN(const PoseFile file, read_pose_file(pose));
  const std::scoped_lock lock(mutex_);
  scene_.X_GO = file.pose();
  scenery_.reset();
  return {};
}

void Eyes::clear() {
  const std::scoped_lock lock(mutex_);
  sight_.camera = depth_scene::CameraState::kWell;
  sight_.markers.clear();
}

}  // namespace hydroprint::virtual_rig
