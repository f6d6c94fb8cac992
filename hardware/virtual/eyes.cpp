#include "hardware/virtual/eyes.h"

#include <utility>

#include "hardware/depth_scene/codec.h"
#include "hardware/depth_scene/hand.h"
#include "hardware/depth_scene/shapes.h"
#include "sim/base/pose_file.h"
#include "sim/mesh/read_model.h"

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

Result<std::size_t> Eyes::index_of(const std::string& marker) const {
  std::string names;
  for (std::size_t i = 0; i < scene_.markers.size(); ++i) {
    names += (names.empty() ? "" : ", ") + scene_.markers[i].name;
    if (scene_.markers[i].name == marker) return i;
  }
  return fail(Code::kInvalidArgument, "no marker is called \"" + marker.substr(0, 40) +
                                          "\". Name one of " +
                                          (names.empty() ? "a --scene's" : names));
}

Status Eyes::set(const std::string& marker, depth_scene::MarkerState state) {
  const std::scoped_lock lock(mutex_);
  HP_ASSIGN_OR_RETURN(const std::size_t i, index_of(marker));
  sight_.markers.resize(scene_.markers.size(), depth_scene::MarkerState::kWell);
  sight_.markers[i] = state;
  return {};
}

Status Eyes::push(const std::string& marker, const Eigen::Vector2d& by_mm) {
  const std::scoped_lock lock(mutex_);
  HP_ASSIGN_OR_RETURN(const std::size_t i, index_of(marker));
  scene_.markers[i].at_mm.head<2>() += by_mm;
  scenery_.reset();
  return {};
}

Status Eyes::hang(const std::filesystem::path& pose, const std::filesystem::path& mesh) {
  HP_ASSIGN_OR_RETURN(const PoseFile file, read_pose_file(pose));
  const std::scoped_lock lock(mutex_);
  Scene next = scene_;
  next.X_GO = file.pose();
  if (!mesh.empty()) {
    next.mesh = mesh;
    next.scale = 1;
  }
  HP_ASSIGN_OR_RETURN(const depth_scene::Scenery scenery, scenery_of(next));
  scene_ = std::move(next);
  scenery_ = depth_scene::to_json(scenery);
  return {};
}

Status Eyes::show(const std::filesystem::path& pose, const std::filesystem::path& mesh) {
  const std::scoped_lock lock(mutex_);
  scenery_.reset();
  if (mesh.empty()) return {};
  HP_ASSIGN_OR_RETURN(const PoseFile file, read_pose_file(pose));
  HP_ASSIGN_OR_RETURN(depth_scene::Scenery scenery, scenery_of(scene_));
  HP_ASSIGN_OR_RETURN(mesh::Model model, mesh::read_model(mesh, 1, {}));
  const Pose X_FC = depth_scene::camera_pose(scenery.stand, scenery.seed, 0);
  depth_scene::Mesh held{std::move(model.vertices), std::move(model.triangles)};
  scenery.bodies = {{"held", depth_scene::moved(std::move(held), X_FC * file.pose()), false}};
  scenery.markers.clear();
  scenery_ = depth_scene::to_json(scenery);
  return {};
}

void Eyes::clear() {
  const std::scoped_lock lock(mutex_);
  sight_.camera = depth_scene::CameraState::kWell;
  sight_.markers.clear();
}

}  // namespace hydroprint::virtual_rig
