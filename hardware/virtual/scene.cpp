#include "hardware/virtual/scene.h"

#include "sim/base/input_file.h"
#include "sim/base/pose_file.h"
#include "sim/base/toml_reader.h"

namespace hydroprint::virtual_rig {
namespace {

constexpr double kFarthest_mm = 1e4;

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
  HP_RETURN_IF_ERROR(top.finish());
  return scene;
}

}  // namespace hydroprint::virtual_rig
