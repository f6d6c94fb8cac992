#include "daemon/dip/record.h"

#include <algorithm>
#include <cmath>
#include <iomanip>

#include "proto/warning_message.h"
#include "proto/write_json.h"
#include "sim/base/utf8.h"

namespace hydroprint::dip {
namespace {

void add_parameters(const Plan& plan, v1::DipReport::Parameters& out) {
  out.set_depth_mm(plan.depth_mm);
  out.set_speed_mm_per_s(plan.speed_mm_per_s);
  out.set_hold_s(plan.hold_s);
  out.set_retract_speed_mm_per_s(plan.retract_speed_mm_per_s);
  out.set_clearance_mm(plan.clearance_mm);
  out.set_film_area_mm2(plan.film_area_mm2);
  out.set_activator_ml_per_m2(plan.activator_ml_per_m2);
  out.set_activator_ml(plan.activator_ml());
  out.set_soak_s(plan.clocks.soak_s);
  out.set_activator_wait_s(plan.clocks.activator_wait_s);
  out.set_activation_window_s(plan.clocks.activation_window_s);
  out.set_yes_to_all(plan.clocks.skip);
  if (plan.water_temperature_c) out.set_water_temperature_c(*plan.water_temperature_c);
}

void add_step(const StepRecord& step, v1::DipReport::Step& out) {
  out.set_step(std::string(name(step.step)));
  out.set_begin_s(step.begin_s);
  if (step.end_s) out.set_end_s(*step.end_s);
  if (step.planned_s) out.set_planned_s(*step.planned_s);
  if (step.end_s) out.set_actual_s(*step.end_s - step.begin_s);
  out.set_confirmed_by(step.confirmed_by);
}

void add_axis(const Facts& facts, v1::DipReport::Axis& out) {
  if (facts.stand.loaded_mm) out.set_loaded_mm(*facts.stand.loaded_mm);
  if (facts.stand.contact_mm) out.set_contact_mm(*facts.stand.contact_mm);
  out.set_contact_from_calibration(facts.plan.contact_mm.has_value());
  if (!facts.ways) return;
  out.set_clear_mm(facts.ways->clear_mm);
  out.set_bottom_mm(facts.ways->bottom_mm);
  out.set_up_mm(facts.ways->up_mm);
}

void add_descent(const Facts& facts, v1::DipReport::Descent& out) {
  const rig::ConstantSpeed& was = *facts.descent;
  out.set_speed_asked_mm_per_s(facts.plan.speed_mm_per_s);
  out.set_speed_mm_per_s(was.speed_mm_per_s);
  out.set_largest_deviation_share(was.largest_share);
  out.set_largest_deviation_mm(was.largest_way_mm);
  out.set_deviation_uncertainty_mm(was.way_uncertainty_mm);
  out.set_window_s(was.window_s);
  out.set_samples(static_cast<std::int32_t>(was.samples));
}

tl::unexpected<Error> not_written(const std::filesystem::path& path) {
  return fail(Code::kResourceExhausted,
              path.string() + ": cannot be written; check whether the disk is full",
              ErrorReason::DISK_FULL);
}

}  // namespace

v1::DipReport report_of(const Facts& facts) {
  v1::DipReport out;
  v1::RunFacts& run = *out.mutable_run();
  run.set_program("hydroprintd");
  run.set_version(HYDROPRINT_VERSION);
  run.set_verb("dip");
  add_warnings(facts.warnings, *run.mutable_warnings());
  run.add_artifacts(PositionLog::kName);
  out.set_job(facts.job);
  out.set_create_time(facts.create_time);
  out.set_outcome(facts.outcome);
  out.set_reason(static_cast<v1::ErrorReason>(facts.reason));
  out.set_message(one_line(facts.message));
  out.set_step(std::string(name(facts.stand.step)));
  out.set_simulate_job(facts.plan.simulate_job);
  out.set_calibration(facts.plan.calibration);
  out.set_lease_holder(facts.lease_holder);
  out.set_drive(one_line(facts.drive));
  out.set_virtual_(facts.is_virtual);
  add_parameters(facts.plan, *out.mutable_parameters());
  add_axis(facts, *out.mutable_axis());
  if (facts.deepest_mm) out.set_depth_reached_mm(*facts.deepest_mm);
  if (facts.descent) add_descent(facts, *out.mutable_descent());
  for (const StepRecord& step : facts.steps) add_step(step, *out.add_steps());
  return out;
}

rig::ConstantSpeed immersion_speed(std::span<const rig::Sample> samples, std::uint64_t motion,
                                   double contact_mm) {
  std::vector<rig::Sample> wet;
  std::copy_if(samples.begin(), samples.end(), std::back_inserter(wet),
               [&](const rig::Sample& sample) { return sample.position_mm >= contact_mm; });
  return rig::constant_speed(wet, motion, 0);
}

PositionLog::PositionLog(const std::filesystem::path& folder, rig::TimePoint begun)
    : path_(folder / kName), begun_(begun), file_(path_, std::ios::binary | std::ios::trunc) {
  file_ << "t_s,depth_mm,position_mm,velocity_mm_per_s,expected_mm,leg,motion\n" << std::fixed;
}

void PositionLog::add(std::span<const rig::Sample> samples, std::string_view motion,
                      double contact_mm) {
  for (const rig::Sample& sample : samples) {
    file_ << std::setprecision(4) << std::chrono::duration<double>(sample.time - begun_).count()
          << ',' << sample.position_mm - contact_mm << ',' << sample.position_mm << ','
          << sample.velocity_mm_per_s << ',';
    if (std::isfinite(sample.expected_mm)) file_ << sample.expected_mm;
    file_ << ',' << sample.leg << ',' << motion << '\n';
  }
}

Status PositionLog::flush() {
  if (file_.flush()) return {};
  return not_written(path_);
}

Status write_report(const std::filesystem::path& folder, const v1::DipReport& report) {
  HP_ASSIGN_OR_RETURN(const std::string json, json_file_of(report));
  const auto path = folder / "report.json";
  const auto next = folder / "report.next";
  std::ofstream file(next, std::ios::binary | std::ios::trunc);
  file << json;
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(next, path, error);
  if (file && !error) return {};
  std::filesystem::remove(next, error);
  return not_written(path);
}

}  // namespace hydroprint::dip
