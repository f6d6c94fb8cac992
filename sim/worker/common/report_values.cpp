#include "sim/worker/common/report_values.h"

#include <Eigen/Geometry>
#include <cstdint>

#include "hydroprint/v1/report.pb.h"

namespace hydroprint::worker {

void set_pose(const Pose& X_FO, v1::Pose& out) {
  const Eigen::Quaterniond q(X_FO.linear());
  out.clear_rotation_wxyz();
  for (const double x : {q.w(), q.x(), q.y(), q.z()}) out.add_rotation_wxyz(x);
  out.clear_translation_mm();
  for (const double x : X_FO.translation()) out.add_translation_mm(x);
}

void set_film(const film::Outline& outline, v1::FilmFacts& out) {
  out.set_name(outline.name);
  add_all(outline.min_mm, out.mutable_min_mm());
  add_all(outline.max_mm, out.mutable_max_mm());
  out.set_corners(static_cast<std::int32_t>(outline.polygon.size()));
}

void set_mesh(const mesh::Model& model, v1::MeshFacts& out) {
  out.set_vertices(static_cast<std::int32_t>(model.vertices.size()));
  out.set_triangles(static_cast<std::int32_t>(model.triangles.size()));
}

void set_surface(const mesh::Surface& surface, v1::MeshFacts& out) {
  out.set_surface_points(static_cast<std::int32_t>(surface.points.size()));
  out.set_surface_triangles(static_cast<std::int32_t>(surface.triangles.size()));
  out.set_closed(surface.closed);
}

}  // namespace hydroprint::worker
