// Guides the operator through the immersion on the rig.
#include <fmt/format.h>

#include "daemon/jobs/calibration_binding.h"
#include "daemon/jobs/kind.h"
#include "daemon/jobs/referenced_job.h"
#include "daemon/platform/resource_names.h"

namespace hydroprint::daemon {
namespace {

class DipKind final : public KindOf<v1::DipSpec> {
 public:
  [[nodiscard]] auth::Role least_role() const override { return auth::Role::kOperator; }
  [[nodiscard]] ExecutorId executor() const override { return ExecutorId::kDips; }
  [[nodiscard]] bool is_cacheable() const override { return false; }
  [[nodiscard]] JobTraits traits() const override {
    JobTraits out;
    out.computed = false;
    return out;
  }
  [[nodiscard]] std::string why_no_retry() const override {
    return "a dip, which needs a new film; create a new dip";
  }

 private:
  /// A dip without a calibration uses the calibration of its simulation.
  [[nodiscard]] Status resolve_spec(v1::DipSpec& shown, v1::DipSpec& resolved,
                                    const JobSources& sources) const override {
    std::string simulated;
    if (!shown.simulate_job().empty()) {
      HP_ASSIGN_OR_RETURN(
          const EarlierSimulation simulation,
          earlier_simulation(shown.simulate_job(), "dip.simulate_job", sources.jobs));
      simulated = simulation.spec.calibration();
    }
    const std::string name = shown.calibration().empty() ? simulated : shown.calibration();
    if (name.empty()) return {};
    HP_ASSIGN_OR_RETURN(const Calibration found,
                        needed_calibration(name, "dip.calibration", sources.calibrations));
    shown.set_calibration(calibration_name(found.id));
    if (!simulated.empty() && simulated != shown.calibration()) {
      return invalid_field("dip.calibration",
                           fmt::format("is not the calibration that {} was computed with ({}); "
                                       "leave this field out, or simulate again",
                                       shown.simulate_job(), simulated));
    }
    resolved = shown;
    return {};
  }

  [[nodiscard]] Status check_spec(const v1::DipSpec& spec) const override {
    if (!spec.simulate_job().empty()) {
      HP_RETURN_IF_ERROR(parse_job_name(spec.simulate_job()));
    } else if (!spec.has_depth_mm()) {
      return invalid_field("dip.depth_mm", "is missing; set it, or name a simulate_job");
    }
    return {};
  }
};

}  // namespace

const JobKind& dip_kind() {
  static const DipKind kind;
  return kind;
}

}  // namespace hydroprint::daemon
