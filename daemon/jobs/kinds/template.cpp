// Creates a page that shows where to place the object.
#include "daemon/jobs/kind.h"
#include "daemon/jobs/referenced_job.h"
#include "daemon/jobs/spec_fields.h"

namespace hydroprint::daemon {
namespace {

class TemplateKind final : public KindOf<v1::TemplateSpec> {
 private:
  /// If a simulate job is named, the object, its pose and the film are taken from it.
  [[nodiscard]] Status resolve_spec(v1::TemplateSpec& shown, v1::TemplateSpec& resolved,
                                    const JobSources& sources) const override {
    if (shown.simulate_job().empty()) return {};
    HP_RETURN_IF_ERROR(take_simulation(resolved, sources));
    resolved.clear_simulate_job();
    return {};
  }

  [[nodiscard]] Status check_spec(const v1::TemplateSpec& spec) const override {
    HP_RETURN_IF_ERROR(check_polygon(field().name(), spec));
    return check_margin(field().name(), spec);
  }

  [[nodiscard]] static Status take_simulation(v1::TemplateSpec& spec, const JobSources& sources) {
    HP_ASSIGN_OR_RETURN(
        const EarlierSimulation simulation,
        earlier_simulation(spec.simulate_job(), "template.simulate_job", sources.jobs));
    const v1::SimulateSpec& simulated = simulation.spec;
    *spec.mutable_mesh() = simulated.mesh();
    *spec.mutable_extra_files() = simulated.extra_files();
    if (simulated.has_scale()) spec.set_scale(simulated.scale());
    if (simulated.has_pose()) *spec.mutable_pose() = simulated.pose();
    if (simulated.has_film()) spec.set_film(simulated.film());
    return {};
  }
};

}  // namespace

const JobKind& template_kind() {
  static const TemplateKind kind;
  return kind;
}

}  // namespace hydroprint::daemon
