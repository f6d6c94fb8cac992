#include "sim/worker/common/report_values.h"

#include <Eigen/Geometry>

namespace hydroprint::worker {

Json pair_of(const Eigen::Vector2d& v) { return {v.x(), v.y()}; }

Json list_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Json pose_json(const Pose& X_FO) {
  const Eigen::Quaterniond q(X_FO.linear());
  return {{"rotation_wxyz", {q.w(), q.x(), q.y(), q.z()}},
          {"translation_mm", list_of(X_FO.translation())}};
}

Json film_json(const film::Outline& outline) {
  return {{"name", outline.name},
          {"min_mm", pair_of(outline.min_mm)},
          {"max_mm", pair_of(outline.max_mm)},
          {"corners", outline.polygon.size()}};
}

Json warnings_json(const Warnings& warnings) {
  Json out = Json::array();
  for (const Warning& warning : warnings) {
    out.push_back({{"code", warning.code}, {"message", warning.message}, {"where", warning.where}});
  }
  return out;
}

Json mesh_json(const MeshSize& size) {
  return {{"vertices", size.vertices}, {"triangles", size.triangles}};
}

}  // namespace hydroprint::worker
