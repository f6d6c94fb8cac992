#include "hardware/simulator/drive/camera_control.h"

#include <fmt/format.h>

#include <utility>

#include "hardware/simulator/scene/codec.h"
#include "hardware/simulator/scene/hand.h"
#include "hardware/simulator/scene/shapes.h"
#include "sim/base/pose_file.h"
#include "sim/mesh/read/read_model.h"

namespace hydroprint::simulated_drive {

Result<std::string> CameraControl::scenery_json() {
  const std::scoped_lock lock(mutex_);
  if (!scenery_) {
    HP_ASSIGN_OR_RETURN(const simulated_scene::Scenery scenery, scenery_of(scene_));
    scenery_ = simulated_scene::to_json(scenery);
  }
  return *scenery_;
}

std::string CameraControl::sight_json(double time_s, double x_mm) {
  const std::scoped_lock lock(mutex_);
  sight_.time_s = time_s;
  sight_.gripper_height_mm = scene_.water_mm - x_mm;
  return simulated_scene::to_json(sight_);
}

void CameraControl::set(simulated_scene::CameraState state) {
  const std::scoped_lock lock(mutex_);
  sight_.camera = state;
}

Result<std::size_t> CameraControl::index_of(const std::string& marker) const {
  std::string names;
  for (std::size_t i = 0; i < scene_.markers.size(); ++i) {
    names += (names.empty() ? "" : ", ") + scene_.markers[i].name;
    if (scene_.markers[i].name == marker) return i;
  }
  return fail(Code::kInvalidArgument,
              fmt::format("unknown marker \"{:.40}\". Use one of {}", marker,
                          names.empty() ? "the markers in --scene" : names));
}

Status CameraControl::set(const std::string& marker, simulated_scene::MarkerState state) {
  const std::scoped_lock lock(mutex_);
  HP_ASSIGN_OR_RETURN(const std::size_t i, index_of(marker));
  sight_.markers.resize(scene_.markers.size(), simulated_scene::MarkerState::kWell);
  sight_.markers[i] = state;
  return {};
}

Status CameraControl::push(const std::string& marker, const Eigen::Vector2d& by_mm) {
  const std::scoped_lock lock(mutex_);
  HP_ASSIGN_OR_RETURN(const std::size_t i, index_of(marker));
  scene_.markers[i].at_mm.head<2>() += by_mm;
  scenery_.reset();
  return {};
}

Status CameraControl::set_object(const std::filesystem::path& pose,
                                 const std::filesystem::path& mesh) {
  HP_ASSIGN_OR_RETURN(const PoseFile file, read_pose_file(pose));
  const std::scoped_lock lock(mutex_);
  Scene next = scene_;
  next.X_GO = file.pose();
  if (!mesh.empty()) {
    next.mesh = mesh;
    next.scale = 1;
  }
  HP_ASSIGN_OR_RETURN(const simulated_scene::Scenery scenery, scenery_of(next));
  scene_ = std::move(next);
  scenery_ = simulated_scene::to_json(scenery);
  return {};
}

Status CameraControl::show(const std::filesystem::path& pose, const std::filesystem::path& mesh) {
  const std::scoped_lock lock(mutex_);
  scenery_.reset();
  if (mesh.empty()) return {};
  HP_ASSIGN_OR_RETURN(const PoseFile file, read_pose_file(pose));
  HP_ASSIGN_OR_RETURN(simulated_scene::Scenery scenery, scenery_of(scene_));
  HP_ASSIGN_OR_RETURN(mesh::Model model, mesh::read_model(mesh, 1, {}));
  const Pose X_FC = simulated_scene::camera_pose(scenery.stand, scenery.seed, 0);
  simulated_scene::Mesh held{std::move(model.vertices), std::move(model.triangles)};
  scenery.bodies = {{"held", simulated_scene::moved(std::move(held), X_FC * file.pose()), false}};
  scenery.markers.clear();
  scenery_ = simulated_scene::to_json(scenery);
  return {};
}

void CameraControl::clear() {
  const std::scoped_lock lock(mutex_);
  sight_.camera = simulated_scene::CameraState::kWell;
  sight_.markers.clear();
}

}  // namespace hydroprint::simulated_drive
