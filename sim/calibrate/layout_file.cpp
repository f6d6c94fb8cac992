#include "sim/calibrate/layout_file.h"

#include <numbers>
#include <string>
#include <utility>

#include "sim/base/look_at.h"
#include "sim/base/toml_reader.h"

namespace hydroprint::calibrate {
namespace {

constexpr double kFarthest_mm = 1e4;
constexpr double kRadians = std::numbers::pi / 180;

void read_markers(TomlReader& top, registration::MarkerLayout& out) {
  TomlReader size = top.table("markers");
  out.width_mm = size.number("width_mm", 5, 500, out.width_mm);
  out.height_mm = size.number("height_mm", 5, 500, out.height_mm);
  for (TomlReader& from : top.tables("marker")) {
    Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();
    from.vector("at_mm", -kFarthest_mm, kFarthest_mm, at_mm);
    registration::Marker marker{from.text("name"), Pose(Eigen::Translation3d(at_mm))};
    marker.X_FM.rotate(Eigen::AngleAxisd(kRadians * from.number("turned_deg", -180, 180, 0),
                                         Eigen::Vector3d::UnitZ()));
    for (const auto& other : out.markers)
      if (other.name == marker.name)
        from.refuse("name", "is used by another marker. Use a different name for each marker");
    out.markers.push_back(std::move(marker));
  }
}

Pose read_camera(TomlReader from) {
  Eigen::Vector3d at_mm(0, -350, 720), looks_at_mm(0, 0, 0);
  from.vector("at_mm", -kFarthest_mm, kFarthest_mm, at_mm);
  from.vector("looks_at_mm", -kFarthest_mm, kFarthest_mm, looks_at_mm);
  if (at_mm.isApprox(looks_at_mm)) {
    from.refuse("at_mm", "equals looks_at_mm. Move one of them");
    return Pose::Identity();
  }
  return look_at(at_mm, looks_at_mm, kRadians * from.number("turned_deg", -180, 180, 0));
}

}  // namespace

Result<RigLayout> read_layout(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(TomlReader top, TomlReader::open(path));
  RigLayout out;
  registration::Surroundings& around = out.surroundings;
  read_markers(top, around.layout);
  out.nominal_FC = read_camera(top.table("camera"));
  if (top.has("gripper")) {
    TomlReader gripper = top.table("gripper");
    gripper.vector("at_mm", -kFarthest_mm, kFarthest_mm, around.gripper_mm);
    around.gripper_radius_mm = gripper.number("radius_mm", 0, 1000, around.gripper_radius_mm);
  }
  if (top.has("object")) {
    TomlReader object = top.table("object");
    object.vector("within_mm", 10, kFarthest_mm, around.reach_mm);
    around.clear_mm = object.number("above_mm", 0, 1000, around.clear_mm);
  }
  HP_RETURN_IF_ERROR(top.finish());
  return out;
}

}  // namespace hydroprint::calibrate
