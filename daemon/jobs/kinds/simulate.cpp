// Computes the film image from a textured model.
#include <fmt/format.h>

#include "daemon/jobs/calibration_binding.h"
#include "daemon/jobs/kind.h"
#include "daemon/jobs/plan_binding.h"
#include "daemon/jobs/spec_fields.h"
#include "daemon/platform/resource_names.h"

namespace hydroprint::daemon {
namespace {

class SimulateKind final : public KindOf<v1::SimulateSpec> {
 private:
  /// If a plan is named, object, picture, scale and film are taken from it; if a calibration is
  /// named, pose, scale and film.
  [[nodiscard]] Status resolve_spec(v1::SimulateSpec& shown, v1::SimulateSpec& resolved,
                                    const JobSources& sources) const override {
    const bool has_plan = !shown.plan_job().empty();
    if (has_plan && !shown.plan().empty())
      return invalid_field("simulate.plan", "is set together with plan_job; set one of them");
    if (has_plan) HP_RETURN_IF_ERROR(take_plan(shown, sources));
    if (!shown.calibration().empty()) HP_RETURN_IF_ERROR(take_calibration(shown, sources));
    resolved = shown;
    if (has_plan) HP_RETURN_IF_ERROR(adopt_plan(resolved, sources));
    resolved.clear_calibration();
    resolved.clear_allow_stale_calibration();
    return {};
  }

  [[nodiscard]] Status check_spec(const v1::SimulateSpec& spec) const override {
    HP_RETURN_IF_ERROR(check_polygon(field().name(), spec));
    HP_RETURN_IF_ERROR(check_paint(field().name(), spec));
    return check_inertia(field().name(), spec);
  }

  [[nodiscard]] static Status take_calibration(v1::SimulateSpec& spec, const JobSources& sources) {
    HP_ASSIGN_OR_RETURN(
        const Calibration found,
        needed_calibration(spec.calibration(), "simulate.calibration", sources.calibrations));
    const v1::Calibration calibration = to_message(found, sources.place);
    HP_RETURN_IF_ERROR(check_objection(calibration, objection(calibration, spec.mesh()),
                                       spec.allow_stale_calibration()));
    if (!spec.plan_job().empty()) HP_RETURN_IF_ERROR(check_planned(calibration, spec));
    spec.set_calibration(calibration_name(found.id));
    *spec.mutable_pose() = stated_pose(calibration);
    spec.set_scale(calibration.scale());
    if (!calibration.film().empty()) spec.set_film(calibration.film());
    if (calibration.has_film_file()) add_polygon(calibration.film_file(), spec);
    return {};
  }

  /// The calibration must be for the plan's film and scale.
  [[nodiscard]] static Status check_planned(const v1::Calibration& calibration,
                                            const v1::SimulateSpec& spec) {
    const auto found = mismatch(
        calibration, spec.has_scale() ? std::optional(spec.scale()) : std::nullopt, spec.film());
    if (!found) return {};
    return invalid_field(
        "simulate.calibration",
        fmt::format("{} is for {}, but {} for {}; calibrate with the plan's scale "
                    "and film",
                    calibration.name(), found->own, spec.plan_job(), found->planned));
  }

  static void add_polygon(const v1::InputFile& polygon, v1::SimulateSpec& spec) {
    for (const v1::InputFile& file : spec.extra_files()) {
      if (file.name() == polygon.name() && file.asset() == polygon.asset()) return;
    }
    *spec.add_extra_files() = polygon;
  }
};

}  // namespace

const JobKind& simulate_kind() {
  static const SimulateKind kind;
  return kind;
}

}  // namespace hydroprint::daemon
