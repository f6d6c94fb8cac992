// Computes the film image from a textured model.
#include "daemon/jobs/calibration_binding.h"
#include "daemon/jobs/kind.h"
#include "daemon/jobs/spec_fields.h"
#include "daemon/platform/resource_names.h"

namespace hydroprint::daemon {
namespace {

class SimulateKind final : public KindOf<v1::SimulateSpec> {
 private:
  /// If a calibration is named, pose, scale and film are taken from it.
  [[nodiscard]] Status resolve_spec(v1::SimulateSpec& shown, v1::SimulateSpec& resolved,
                                    const JobSources& sources) const override {
    if (!shown.calibration().empty()) HP_RETURN_IF_ERROR(take_calibration(shown, sources));
    resolved = shown;
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
    spec.set_calibration(calibration_name(found.id));
    *spec.mutable_pose() = stated_pose(calibration);
    spec.set_scale(calibration.scale());
    if (!calibration.film().empty()) spec.set_film(calibration.film());
    if (calibration.has_film_file()) add_polygon(calibration.film_file(), spec);
    return {};
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
