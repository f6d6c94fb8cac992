#include "hardware/simulator/drive/scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "hardware/simulator/scene/rig_layout.h"
#include "hardware/simulator/scene/shapes.h"
#include "sim/base/input_file.h"
#include "sim/base/pose_file.h"
#include "sim/base/toml_reader.h"
#include "sim/mesh/read/read_model.h"

namespace hydroprint::simulated_drive {
namespace {

constexpr double kFarthest_mm = 1e4;
constexpr double kRadians = std::numbers::pi / 180;

void read_object(TomlReader object, const std::filesystem::path& folder, Scene& scene) {
  scene.mesh = folder / object.text("mesh");
  if (const auto opened = open_input_file(scene.mesh); !opened) {
    object.refuse("mesh", "cannot be used: " + opened.error().message);
  }
  scene.scale = object.number("scale", 1e-6, 1e6, 1);
  if (!object.has("pose")) return;
  const auto pose = read_pose_file(folder / object.text("pose"));
  if (pose) {
    scene.X_GO = pose->pose();
  } else {
    object.refuse("pose", "cannot be used: " + pose.error().message);
  }
}

void read_markers(TomlReader top, Scene& scene) {
  scene.markers = simulated_scene::nominal_markers(scene.film_mm);
  if (!top.has("marker")) return;
  std::vector<std::string_view> names;
  for (const simulated_scene::Marker& marker : scene.markers) names.push_back(marker.name);
  for (TomlReader& from : top.tables("marker")) {
    simulated_scene::Marker& marker = scene.markers[from.choice("name", names)];
    Eigen::Vector2d off = Eigen::Vector2d::Zero();
    from.vector("off_mm", -100, 100, off);
    marker.at_mm.head<2>() += off;
    marker.turn_rad += kRadians * from.number("turned_deg", -180, 180, 0);
  }
}

void read_sweep(TomlReader sweep, simulated_scene::CameraStand& stand) {
  for (const toml::node* place : sweep.array("via_mm"))
    sweep.vector("via_mm", *place, -kFarthest_mm, kFarthest_mm, stand.via_mm.emplace_back());
  stand.period_s = sweep.number("period_s", 0.1, 3600, stand.period_s);
  stand.trembles = sweep.flag("trembles", stand.trembles);
}

Camera read_camera(TomlReader from) {
  Camera out;
  simulated_scene::CameraStand& stand = out.stand;
  from.vector("at_mm", -kFarthest_mm, kFarthest_mm, stand.at_mm);
  from.vector("looks_at_mm", -kFarthest_mm, kFarthest_mm, stand.looks_at_mm);
  stand.turn_rad = kRadians * from.number("turned_deg", -180, 180, 0);
  out.seed = static_cast<std::uint64_t>(from.integer("seed", 0, std::int64_t{1} << 53, 1));
  out.has_errors = from.flag("errors", true);
  out.counts_frames = from.choice("clock", {"rig", "frames"}, 0) == 1;
  if (from.has("sweep")) read_sweep(from.table("sweep"), stand);
  const auto is_looked_at = [&](const Eigen::Vector3d& at_mm) {
    return at_mm.isApprox(stand.looks_at_mm);
  };
  if (is_looked_at(stand.at_mm) ||
      std::any_of(stand.via_mm.begin(), stand.via_mm.end(), is_looked_at)) {
    from.refuse("looks_at_mm", "is the camera's own position. Move one of them");
  }
  return out;
}

}  // namespace

Result<Scene> read_scene(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(TomlReader top, TomlReader::open(path));
  Scene scene;
  if (top.has("object")) read_object(top.table("object"), path.parent_path(), scene);
  if (top.has("axis")) {
    TomlReader axis = top.table("axis");
    scene.travel_mm = axis.number("travel_mm", 10, kFarthest_mm, scene.travel_mm);
    scene.start_mm = axis.number("start_mm", -4, scene.travel_mm, scene.start_mm);
  }
  if (top.has("water")) {
    scene.water_mm = top.table("water").number("at_mm", -kFarthest_mm, kFarthest_mm);
  }
  if (top.has("film")) {
    TomlReader film = top.table("film");
    film.vector("size_mm", 10, 2000, scene.film_mm);
  }
  read_markers(top, scene);
  if (top.has("camera")) scene.camera = read_camera(top.table("camera"));
  HP_RETURN_IF_ERROR(top.finish());
  return scene;
}

Result<simulated_scene::Scenery> scenery_of(const Scene& scene) {
  if (!scene.camera) {
    return fail(Code::kNotFound,
                "the virtual rig has no camera. Use a --scene file with a [camera] table",
                ErrorReason::CAMERA_NOT_FOUND);
  }
  simulated_scene::Scenery out;
  out.bodies = simulated_scene::standing_bodies(scene.film_mm);
  out.bodies.push_back(simulated_scene::gripper());
  if (!scene.mesh.empty()) {
    HP_ASSIGN_OR_RETURN(mesh::Model model, mesh::read_model(scene.mesh, scene.scale, {}));
    out.bodies.push_back({"object",
                          simulated_scene::moved(
                              {std::move(model.vertices), std::move(model.triangles)}, scene.X_GO),
                          true});
  }
  out.markers = scene.markers;
  out.stand = scene.camera->stand;
  out.seed = scene.camera->seed;
  out.has_errors = scene.camera->has_errors;
  out.counts_frames = scene.camera->counts_frames;
  return out;
}

}  // namespace hydroprint::simulated_drive
