#include "sim/worker/verbs/plan_report.h"

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "hydroprint/v1/report.pb.h"
#include "sim/worker/common/report_values.h"

namespace hydroprint::worker {
namespace {

void set_pose(const Pose& X_FO, v1::Pose& out) {
  const Eigen::Quaterniond q(X_FO.linear());
  out.clear_rotation_wxyz();
  for (const double x : {q.w(), q.x(), q.y(), q.z()}) out.add_rotation_wxyz(x);
  out.clear_translation_mm();
  for (const double x : X_FO.translation()) out.add_translation_mm(x);
}

void set_stretch(const std::optional<pipeline::StretchQuantiles>& stretch,
                 v1::PlanReport::Stretch& out) {
  if (!stretch) return;
  out.set_p50(stretch->p50);
  out.set_p95(stretch->p95);
  out.set_max(stretch->max);
}

void set_error(const std::optional<pipeline::MapError>& error, v1::PlanReport::MapError& out) {
  if (!error) return;
  if (std::isfinite(error->p50_mm)) out.set_p50_mm(error->p50_mm);
  if (std::isfinite(error->p95_mm)) out.set_p95_mm(error->p95_mm);
  out.set_above_pixel_share(error->above_pixel_share);
  out.set_no_bound_share(error->no_bound_share);
}

void set_dips(const pipeline::Plan& plan, const std::vector<pipeline::DipPrint>& prints,
              v1::PlanReport& out) {
  const double area_mm2 = pipeline::surface_area_mm2(plan);
  for (std::size_t k = 0; k < plan.dips.size(); ++k) {
    v1::PlanReport::Dip& dip = *out.add_immersions();
    const pipeline::DipFigures& figures = plan.dips[k].figures;
    const plan::RegionSize& region = plan.regions.sizes[k];
    dip.set_depth_mm(figures.depth_mm);
    dip.set_stopped_at_film_edge(figures.stopped_at_edge);
    dip.set_reached_share(figures.coverage);
    dip.set_share(area_mm2 > 0 ? region.area_mm2 / area_mm2 : 0);
    dip.set_area_mm2(region.area_mm2);
    dip.set_pieces(region.pieces);
    set_stretch(stretch_of(plan, prints, static_cast<int>(k) + 1), *dip.mutable_stretch());
    set_error(prints[k].own.error, *dip.mutable_error());
  }
}

}  // namespace

void set_poses(const pipeline::Plan& plan, v1::Plan& out) {
  for (std::size_t k = 0; k < plan.dips.size(); ++k)
    set_pose(plan.dips[k].X_FO, *out.mutable_immersions(static_cast<int>(k))->mutable_pose());
}

void set_findings(const pipeline::Plan& plan, const std::vector<pipeline::DipPrint>& prints,
                  v1::PlanReport& out) {
  v1::PlanReport::Mesh& mesh = *out.mutable_mesh();
  mesh.set_vertices(static_cast<std::int32_t>(plan.model.vertices.size()));
  mesh.set_triangles(static_cast<std::int32_t>(plan.model.triangles.size()));
  mesh.set_surface_points(static_cast<std::int32_t>(plan.surface.points.size()));
  mesh.set_surface_triangles(static_cast<std::int32_t>(plan.surface.triangles.size()));
  mesh.set_closed(plan.surface.closed);
  set_dips(plan, prints, out);
  out.set_unreached_share(plan.regions.unreached_share);
  set_stretch(stretch_of(plan, prints, 0), *out.mutable_stretch());
  out.set_seam_mm(plan.regions.seam_mm);
}

void set_run(const Report& report, v1::PlanReport& out) {
  out.set_program("hydroprint-worker");
  out.set_version(HYDROPRINT_VERSION);
  out.set_verb("plan");
  for (const Input& input : report.inputs) {
    v1::ReportInput& added = *out.add_inputs();
    added.set_role(input.file.role);
    added.set_path(utf8(input.file.path.string()));
    added.set_sha256(input.digest.sha256);
    added.set_size_bytes(static_cast<double>(input.digest.size_bytes));
  }
  out.set_threads(report.threads);
  for (const auto& [stage, seconds] : report.stage_seconds)
    (*out.mutable_stage_seconds())[stage] = seconds;
  out.set_total_seconds(report.total_s);
  out.set_peak_memory_bytes(static_cast<double>(peak_memory_bytes()));
  for (const Warning& warning : report.warnings) set_warning(warning, *out.add_warnings());
  for (const std::string& name : report.artifacts) out.add_artifacts(name);
}

}  // namespace hydroprint::worker
