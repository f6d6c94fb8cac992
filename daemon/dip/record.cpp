#include "daemon/dip/record.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>

namespace hydroprint::dip {
namespace {

using Json = nlohmann::ordered_json;

Json optional(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

std::string dump(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json plan_json(const Plan& plan) {
  return {{"depth_mm", plan.depth_mm},
          {"speed_mm_per_s", plan.speed_mm_per_s},
          {"hold_s", plan.hold_s},
          {"retract_speed_mm_per_s", plan.retract_speed_mm_per_s},
          {"clearance_mm", plan.clearance_mm},
          {"film_area_mm2", plan.film_area_mm2},
          {"activator_ml_per_m2", plan.activator_ml_per_m2},
          {"activator_ml", plan.activator_ml()},
          {"soak_s", plan.clocks.soak_s},
          {"activator_wait_s", plan.clocks.activator_wait_s},
          {"activation_window_s", plan.clocks.activation_window_s},
          {"yes_to_all", plan.clocks.skip}};
}

Json steps_json(const std::vector<StepRecord>& steps) {
  Json out = Json::array();
  for (const StepRecord& step : steps) {
    Json entry = {{"step", name(step.step)},
                  {"begin_s", step.begin_s},
                  {"end_s", optional(step.end_s)},
                  {"planned_s", optional(step.planned_s)}};
    entry["actual_s"] = step.end_s ? Json(*step.end_s - step.begin_s) : Json();
    if (!step.confirmed_by.empty()) entry["confirmed_by"] = step.confirmed_by;
    out.push_back(std::move(entry));
  }
  return out;
}

Json axis_json(const Facts& facts) {
  Json out = {{"loaded_mm", optional(facts.stand.loaded_mm)},
              {"contact_mm", optional(facts.stand.contact_mm)},
              {"contact_from_calibration", facts.plan.contact_mm.has_value()}};
  if (!facts.ways) return out;
  out["clear_mm"] = facts.ways->clear_mm;
  out["bottom_mm"] = facts.ways->bottom_mm;
  out["up_mm"] = facts.ways->up_mm;
  return out;
}

Json descent_json(const Facts& facts) {
  if (!facts.descent) return {};
  const rig::ConstantSpeed& was = *facts.descent;
  return {{"speed_asked_mm_per_s", facts.plan.speed_mm_per_s},
          {"speed_mm_per_s", was.speed_mm_per_s},
          {"largest_deviation_share", was.largest_share},
          {"largest_deviation_mm", was.largest_way_mm},
          {"deviation_uncertainty_mm", was.way_uncertainty_mm},
          {"window_s", was.window_s},
          {"samples", was.samples}};
}

Json warnings_json(const Warnings& warnings) {
  Json out = Json::array();
  for (const Warning& warning : warnings) {
    out.push_back({{"code", warning.code}, {"message", warning.message}, {"where", warning.where}});
  }
  return out;
}

tl::unexpected<Error> not_written(const std::filesystem::path& path) {
  return fail(Code::kResourceExhausted,
              path.string() + ": cannot be written; check whether the disk is full", "DISK_FULL");
}

}  // namespace

std::string report_json(const Facts& facts) {
  return dump({{"program", "hydroprintd"},
               {"version", HYDROPRINT_VERSION},
               {"verb", "dip"},
               {"job", facts.job},
               {"create_time", facts.create_time},
               {"outcome", facts.outcome},
               {"reason", facts.reason},
               {"message", facts.message},
               {"step", name(facts.stand.step)},
               {"simulate_job", facts.plan.simulate_job},
               {"calibration", facts.plan.calibration},
               {"lease_holder", facts.lease_holder},
               {"drive", facts.drive},
               {"virtual", facts.is_virtual},
               {"parameters", plan_json(facts.plan)},
               {"water_temperature_c", optional(facts.plan.water_temperature_c)},
               {"axis", axis_json(facts)},
               {"depth_reached_mm", optional(facts.deepest_mm)},
               {"descent", descent_json(facts)},
               {"steps", steps_json(facts.steps)},
               {"warnings", warnings_json(facts.warnings)},
               {"artifacts", {PositionLog::kName, kReportName}}});
}

std::string interrupted_report(const std::string& json, const std::string& message) {
  Json report = Json::parse(json, nullptr, false);
  if (!report.is_object()) return json;
  report["outcome"] = name(Ending::kInterrupted);
  report["message"] = message;
  return dump(report);
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

Status write_report(const std::filesystem::path& folder, const std::string& json) {
  const auto path = folder / kReportName;
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
