// Prepares a film image for printing at exact scale on paper.
#include "daemon/jobs/adopted_files.h"
#include "daemon/jobs/kind.h"
#include "daemon/jobs/referenced_job.h"
#include "daemon/jobs/spec_fields.h"
#include "daemon/platform/resource_names.h"

namespace hydroprint::daemon {
namespace {

constexpr const char* kFilmImage = "film.png";
// The worker's default, for simulations whose spec has no resolution.
constexpr double kDefaultDpi = 300;

class PrintImageKind final : public KindOf<v1::PrintImageSpec> {
 private:
  /// If a simulate job is named, film image, pose, film and resolution are taken from it.
  [[nodiscard]] Status resolve_spec(v1::PrintImageSpec& shown, v1::PrintImageSpec& resolved,
                                    const JobSources& sources) const override {
    if (shown.simulate_job().empty()) return {};
    HP_RETURN_IF_ERROR(take_simulation(resolved, sources));
    resolved.clear_simulate_job();
    return {};
  }

  [[nodiscard]] Status check_spec(const v1::PrintImageSpec& spec) const override {
    HP_RETURN_IF_ERROR(check_polygon(field().name(), spec));
    return check_margin(field().name(), spec);
  }

  [[nodiscard]] static Status take_simulation(v1::PrintImageSpec& spec, const JobSources& sources) {
    HP_ASSIGN_OR_RETURN(
        const EarlierSimulation simulation,
        earlier_simulation(spec.simulate_job(), "print_image.simulate_job", sources.jobs));
    const std::int64_t id = simulation.job.id;
    const auto image = sources.jobs.artifact(id, kFilmImage);
    if (!image) {
      return fail(Code::kFailedPrecondition,
                  job_name(id) + " has no film.png; simulate with all artifacts",
                  ErrorReason::STATE_FORBIDS);
    }
    // A separate folder prevents collisions with the simulation's files.
    HP_ASSIGN_OR_RETURN(*spec.mutable_film_image(),
                        adopt_artifact(id, *image, std::string("image/") + kFilmImage, sources));
    if (simulation.spec.has_pose()) *spec.mutable_pose() = simulation.spec.pose();
    take_film(simulation.spec, spec);
    return {};
  }

  static void take_film(const v1::SimulateSpec& simulation, v1::PrintImageSpec& spec) {
    spec.set_dpi(simulation.has_dpi() ? simulation.dpi() : kDefaultDpi);
    if (!simulation.has_film()) return;
    spec.set_film(simulation.film());
    for (const v1::InputFile& file : simulation.extra_files()) {
      if (simulation.film() == "polygon:" + file.name()) *spec.add_extra_files() = file;
    }
  }
};

}  // namespace

const JobKind& print_image_kind() {
  static const PrintImageKind kind;
  return kind;
}

}  // namespace hydroprint::daemon
