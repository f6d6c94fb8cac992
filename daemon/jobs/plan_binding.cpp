#include "daemon/jobs/plan_binding.h"

#include <fmt/format.h>

#include "daemon/jobs/adopted_files.h"
#include "daemon/jobs/referenced_job.h"
#include "daemon/platform/resource_names.h"

namespace hydroprint::daemon {
namespace {

constexpr const char* kDefaultFilm = "A4";
constexpr const char* kFiles[] = {"plan.json", "plan.ply"};

Status take_object(const v1::ObjectSetup& object, const std::string& plan, v1::SimulateSpec& spec) {
  if (!spec.mesh().asset().empty() && spec.mesh().asset() != object.mesh().asset()) {
    return invalid_field("simulate.mesh",
                         fmt::format("is not the mesh of {} ({}); leave this field out, or make "
                                     "another plan",
                                     plan, object.mesh().name()));
  }
  *spec.mutable_mesh() = object.mesh();
  *spec.mutable_extra_files() = object.extra_files();
  if (object.has_texture()) *spec.mutable_texture() = object.texture();
  if (object.has_paint()) *spec.mutable_paint() = object.paint();
  if (object.has_scale()) spec.set_scale(object.scale());
  if (object.has_project()) spec.set_project(object.project());
  if (object.has_project_size_mm()) spec.set_project_size_mm(object.project_size_mm());
  if (object.has_project_turn_deg()) spec.set_project_turn_deg(object.project_turn_deg());
  return {};
}

void take_film(const v1::PlanSpec& plan, v1::SimulateSpec& spec) {
  const v1::FilmSetup& film = plan.film();
  if (film.has_film()) spec.set_film(film.film());
  if (film.has_profile() && !spec.has_profile()) *spec.mutable_profile() = film.profile();
  if (film.has_dip_speed_mm_per_s() && !spec.has_dip_speed_mm_per_s())
    spec.set_dip_speed_mm_per_s(film.dip_speed_mm_per_s());
  if (film.has_tolerance_mm() && !spec.has_tolerance_mm())
    spec.set_tolerance_mm(film.tolerance_mm());
  if (plan.has_dpi() && !spec.has_dpi()) spec.set_dpi(plan.dpi());
  if (spec.model() != v1::MODEL_UNSPECIFIED) return;
  spec.set_model(film.model());
  if (film.inertia()) spec.set_inertia(true);
  if (film.has_ink_passes() && !spec.has_ink_passes()) spec.set_ink_passes(film.ink_passes());
}

Status take_dip(const v1::PlanSpec& plan, v1::SimulateSpec& spec) {
  const int dips = plan.immersions_size();
  if (!spec.has_immersion()) {
    return invalid_field("simulate.immersion",
                         fmt::format("is missing; set the number of the dip, from 1 to {}", dips));
  }
  if (spec.immersion() < 1 || spec.immersion() > dips) {
    return invalid_field(
        "simulate.immersion",
        fmt::format("is {}, but {} has {} dip{}; set a number from 1 to {}", spec.immersion(),
                    spec.plan_job(), dips, dips == 1 ? "" : "s", dips));
  }
  const v1::DipSetup& dip = plan.immersions(spec.immersion() - 1);
  if (dip.has_pose() && !spec.has_pose()) *spec.mutable_pose() = dip.pose();
  if (dip.has_depth_mm() && !spec.has_depth_mm()) spec.set_depth_mm(dip.depth_mm());
  return {};
}

}  // namespace

Status take_plan(v1::SimulateSpec& spec, const JobSources& sources) {
  HP_ASSIGN_OR_RETURN(const v1::PlanSpec plan,
                      earlier_plan(spec.plan_job(), "simulate.plan_job", sources.jobs));
  HP_RETURN_IF_ERROR(take_dip(plan, spec));
  HP_RETURN_IF_ERROR(take_object(plan.object(), spec.plan_job(), spec));
  take_film(plan, spec);
  return {};
}

std::optional<CalibrationMismatch> mismatch(const v1::Calibration& calibration,
                                            std::optional<double> scale, const std::string& film) {
  const double planned_scale = scale.value_or(1);
  const std::string planned_film = film.empty() ? kDefaultFilm : film;
  if (calibration.scale() != planned_scale) {
    return CalibrationMismatch{fmt::format("scale {:g}", calibration.scale()),
                               fmt::format("{:g}", planned_scale)};
  }
  if (calibration.film().empty() || calibration.film() == planned_film) return std::nullopt;
  return CalibrationMismatch{"film " + calibration.film(), planned_film};
}

Status adopt_plan(v1::SimulateSpec& spec, const JobSources& sources) {
  HP_ASSIGN_OR_RETURN(const std::int64_t id, parse_job_name(spec.plan_job()));
  for (const char* name : kFiles) {
    const auto artifact = sources.jobs.artifact(id, name);
    if (!artifact) {
      return fail(Code::kFailedPrecondition,
                  fmt::format("{} has no {}; retry that job", spec.plan_job(), name),
                  ErrorReason::STATE_FORBIDS);
    }
    HP_ASSIGN_OR_RETURN(*spec.add_plan(),
                        adopt_artifact(id, *artifact, std::string("plan/") + name, sources));
  }
  spec.clear_plan_job();
  return {};
}

}  // namespace hydroprint::daemon
