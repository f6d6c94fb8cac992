#include "daemon/dip/job_plan.h"

#include <fmt/format.h>

#include <numbers>

#include "daemon/jobs/calibration_binding.h"
#include "daemon/jobs/referenced_job.h"
#include "daemon/platform/resource_names.h"
#include "hydroprint/v1/spec.pb.h"
#include "proto/warning_message.h"
#include "sim/base/pose_uncertainty.h"

namespace hydroprint::daemon {
namespace {

/// Takes numbers from a report and keeps the first error.
class Checked {
 public:
  double number(const char* name, double value, double least, double most) {
    if (value >= least && value <= most) return value;
    if (status_) {
      status_ = fail(Code::kFailedPrecondition,
                     fmt::format("report of the simulation: {} is not a number from {:g} to {:g}; "
                                 "simulate again, or set all values taken from it in the dip's "
                                 "spec",
                                 name, least, most),
                     ErrorReason::STATE_FORBIDS);
    }
    return 0;
  }
  [[nodiscard]] const Status& status() const { return status_; }

 private:
  Status status_;
};

/// Returns the area of the film; for a polygon, the area of its bounding box.
double film_area_mm2(const v1::FilmFacts& film, Checked& checked) {
  double area_mm2 = film.name().starts_with("circle:") ? std::numbers::pi / 4 : 1;
  for (const int axis : {0, 1}) {
    const bool is_there = film.min_mm_size() > axis && film.max_mm_size() > axis;
    const double side_mm = is_there ? film.max_mm(axis) - film.min_mm(axis) : 0;
    area_mm2 *= checked.number("the size of the film", side_mm, 1e-3, 4000);
  }
  return area_mm2;
}

Result<SimulatedDip> simulated_dip(const std::string& name, JobStore& jobs, const Layout& layout) {
  HP_ASSIGN_OR_RETURN(const Job job, earlier_job(name, "simulate", "dip.simulate_job", jobs));
  HP_ASSIGN_OR_RETURN(const v1::JobReport report, report_of(job, jobs, layout));
  return read_simulated_dip(report.simulate());
}

void fill_from(const SimulatedDip& simulated, dip::Plan& plan) {
  plan.depth_mm = simulated.depth_mm;
  plan.speed_mm_per_s = simulated.speed_mm_per_s;
  plan.film_area_mm2 = simulated.film_area_mm2;
  plan.activator_ml_per_m2 = simulated.activator_ml_per_m2;
  plan.clocks.soak_s = simulated.soak_s;
  plan.clocks.activator_wait_s = simulated.activator_wait_s;
  plan.immersion = simulated.immersion;
  plan.immersions = simulated.immersions;
  plan.warnings = simulated.warnings;
}

void fill_from(const v1::DipSpec& spec, dip::Plan& plan) {
  if (spec.has_depth_mm()) plan.depth_mm = spec.depth_mm();
  if (spec.has_speed_mm_per_s()) plan.speed_mm_per_s = spec.speed_mm_per_s();
  if (spec.has_hold_s()) plan.hold_s = spec.hold_s();
  plan.retract_speed_mm_per_s =
      spec.has_retract_speed_mm_per_s() ? spec.retract_speed_mm_per_s() : plan.speed_mm_per_s;
  if (spec.has_clearance_mm()) plan.clearance_mm = spec.clearance_mm();
  if (spec.has_film_area_mm2()) plan.film_area_mm2 = spec.film_area_mm2();
  if (spec.has_activator_ml_per_m2()) plan.activator_ml_per_m2 = spec.activator_ml_per_m2();
  if (spec.has_soak_s()) plan.clocks.soak_s = spec.soak_s();
  if (spec.has_activator_wait_s()) plan.clocks.activator_wait_s = spec.activator_wait_s();
  if (spec.has_activation_window_s()) {
    plan.clocks.activation_window_s = spec.activation_window_s();
  }
  if (spec.has_water_temperature_c()) plan.water_temperature_c = spec.water_temperature_c();
  plan.clocks.skip = spec.yes_to_all();
}

/// Adds the warnings of an uncertain pose: that of a simulation or of a calibration.
template <class Message>
void doubt(const Message& stated, const std::string& source, dip::Plan& plan) {
  for (Warning& warning : pose_warnings(uncertainty_of(stated), {OfResource{source}})) {
    plan.warnings.push_back(std::move(warning));
    plan.has_uncertain_pose = true;
  }
}

}  // namespace

Result<SimulatedDip> read_simulated_dip(const v1::SimulateReport& report) {
  Checked checked;
  const v1::DipFacts& dip = report.parameters().dip();
  SimulatedDip out;
  out.depth_mm = checked.number("depth_mm", report.flow().depth_mm(), 1e-3, 1e6);
  out.speed_mm_per_s = checked.number("dip_speed_mm_per_s", dip.dip_speed_mm_per_s(), 1e-3, 1000);
  out.film_area_mm2 = film_area_mm2(dip.film(), checked);
  const v1::ProfileFacts& profile = dip.profile();
  out.activator_ml_per_m2 =
      checked.number("activator_ml_per_m2", profile.activator_ml_per_m2(), 0, 1000);
  out.soak_s = checked.number("soak_s", profile.soak_s(), 0, 3600);
  out.activator_wait_s = checked.number("activator_wait_s", profile.activator_wait_s(), 0, 3600);
  if (report.has_plan()) {
    out.immersion = static_cast<int>(checked.number("immersion", report.plan().immersion(), 1, 12));
    out.immersions =
        static_cast<int>(checked.number("immersions", report.plan().immersions(), 1, 12));
    for (const v1::Warning& warning : plan_warnings(report))
      out.warnings.push_back(to_warning(warning));
  }
  HP_RETURN_IF_ERROR(checked.status());
  return out;
}

Result<dip::Plan> plan_of(const v1::DipSpec& spec, JobStore& jobs, const Layout& layout) {
  dip::Plan plan;
  if (!spec.simulate_job().empty()) {
    plan.simulate_job = spec.simulate_job();
    HP_ASSIGN_OR_RETURN(const SimulatedDip simulated,
                        simulated_dip(spec.simulate_job(), jobs, layout));
    fill_from(simulated, plan);
    if (spec.has_depth_mm() && spec.depth_mm() > simulated.depth_mm) {
      plan.warnings.push_back(
          {WarningCode::DEEPER_THAN_SIMULATED,
           fmt::format("the dip is deeper than the simulated {:g} mm; the film image "
                       "was not computed for greater depths",
                       simulated.depth_mm),
           {OfResource{spec.simulate_job()}}});
    }
  }
  fill_from(spec, plan);
  return plan;
}

Status go_by_calibration(const v1::DipSpec& spec, JobStore& jobs, CalibrationStore& calibrations,
                         const RigPlace& now, dip::Plan& plan) {
  v1::SimulateSpec simulated;
  if (!spec.simulate_job().empty()) {
    HP_ASSIGN_OR_RETURN(auto simulation,
                        earlier_simulation(spec.simulate_job(), "dip.simulate_job", jobs));
    simulated = std::move(simulation.spec);
    plan.plan_job = simulated.plan_job();
    doubt(simulated.pose(), spec.simulate_job(), plan);
  }
  if (spec.calibration().empty()) return {};
  HP_ASSIGN_OR_RETURN(const Calibration found,
                      needed_calibration(spec.calibration(), "dip.calibration", calibrations));
  const v1::Calibration calibration = to_message(found, now);
  const Objection why = objection(calibration, simulated.mesh());
  HP_RETURN_IF_ERROR(check_objection(calibration, why, spec.allow_stale_calibration()));
  plan.calibration = calibration.name();
  if (!why.words.empty()) {
    plan.warnings.push_back(
        {WarningCode::CALIBRATION_STALE,
         fmt::format("{} is no longer valid: {}", calibration.name(), why.words),
         {OfResource{calibration.name()}}});
  }
  if (!spec.simulate_job().empty() && simulated.calibration().empty()) {
    plan.warnings.push_back(
        {WarningCode::POSE_NOT_SIMULATED,
         fmt::format("{} was not computed for the pose of {}; the print may not fit",
                     spec.simulate_job(), calibration.name()),
         {OfResource{spec.simulate_job()}}});
  }
  if (simulated.calibration() != calibration.name()) {
    doubt(calibration, calibration.name(), plan);
  }
  if (!knows_contact(calibration)) return {};
  plan.contact_mm = calibration.contact_mm();
  plan.homings = found.captured->place.homings;
  return {};
}

}  // namespace hydroprint::daemon
