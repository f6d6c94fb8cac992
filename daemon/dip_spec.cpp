#include "daemon/dip_spec.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "daemon/earlier_job.h"
#include "daemon/names.h"
#include "hydroprint/v1/spec.pb.h"

namespace hydroprint::daemon {
namespace {

using Json = nlohmann::json;

constexpr const char* kReport = "report.json";

std::string text(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

/// One number of a spec and what it may be.
struct Range {
  const char* field;
  bool is_there;
  double value;
  double least;
  double most;
  bool above_least = false;  ///< the least itself is refused
};

Status check_range(const Range& range) {
  if (!range.is_there) return {};
  const bool enough = range.above_least ? range.value > range.least : range.value >= range.least;
  if (enough && range.value <= range.most) return {};  // not so for NaN
  return invalid_field(std::string("dip.") + range.field,
                       (range.above_least ? "must be above " : "must be at least ") +
                           text(range.least) + " and at most " + text(range.most));
}

/// Takes numbers out of a report; keeps the first thing that is wrong.
class ReportReader {
 public:
  explicit ReportReader(const Json& report) : report_(report) {}

  double number(const std::string& pointer, double least, double most) {
    const Json::json_pointer place(pointer);
    if (report_.contains(place) && report_.at(place).is_number()) {
      const double value = report_.at(place).get<double>();
      if (value >= least && value <= most) return value;
    }
    if (status_) {
      status_ = fail(Code::kFailedPrecondition,
                     "the simulation's " + std::string(kReport) + ": " + pointer +
                         " is not a number from " + text(least) + " to " + text(most) +
                         "; simulate again, or give all that it would say in the dip's spec",
                     "STATE_FORBIDS");
    }
    return 0;
  }
  [[nodiscard]] bool is_round() const {
    const Json::json_pointer place("/parameters/film/name");
    if (!report_.contains(place) || !report_.at(place).is_string()) return false;
    return report_.at(place).get<std::string>().starts_with("circle:");
  }
  [[nodiscard]] const Status& status() const { return status_; }

 private:
  const Json& report_;
  Status status_;
};

/// Of a polygon, the area of the box around it.
double film_area_mm2(ReportReader& reader) {
  double area_mm2 = reader.is_round() ? std::numbers::pi / 4 : 1;
  for (const char* axis : {"0", "1"}) {
    const std::string film = "/parameters/film/";
    const double least = reader.number(film + "min_mm/" + axis, -2000, 2000);
    const double most = reader.number(film + "max_mm/" + axis, -2000, 2000);
    area_mm2 *= std::max(0.0, most - least);
  }
  return area_mm2;
}

Result<SimulatedDip> simulated_dip(const std::string& name, JobStore& jobs, const Layout& layout) {
  HP_ASSIGN_OR_RETURN(const Job job, earlier_job(name, "simulate", "dip.simulate_job", jobs));
  HP_ASSIGN_OR_RETURN(const std::string report, report_of(job, layout));
  return read_simulated_dip(report);
}

void fill_from(const SimulatedDip& simulated, dip::Plan& plan) {
  plan.depth_mm = simulated.depth_mm;
  plan.speed_mm_per_s = simulated.speed_mm_per_s;
  plan.film_area_mm2 = simulated.film_area_mm2;
  plan.activator_ml_per_m2 = simulated.activator_ml_per_m2;
  plan.clocks.soak_s = simulated.soak_s;
  plan.clocks.activator_wait_s = simulated.activator_wait_s;
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

}  // namespace

Status check_dip_spec(const v1::DipSpec& spec) {
  if (spec.simulate_job().empty() && !spec.has_depth_mm()) {
    return invalid_field("dip.depth_mm", "is missing; give it, or the simulate_job that says it");
  }
  if (!spec.simulate_job().empty()) HP_RETURN_IF_ERROR(parse_job_name(spec.simulate_job()));
  const Range ranges[] = {
      {"depth_mm", spec.has_depth_mm(), spec.depth_mm(), 0, 1e6, true},
      {"speed_mm_per_s", spec.has_speed_mm_per_s(), spec.speed_mm_per_s(), 0, 1000, true},
      {"hold_s", spec.has_hold_s(), spec.hold_s(), 0, 600},
      {"retract_speed_mm_per_s", spec.has_retract_speed_mm_per_s(), spec.retract_speed_mm_per_s(),
       0, 1000, true},
      {"clearance_mm", spec.has_clearance_mm(), spec.clearance_mm(), dip::kLeastClearance_mm, 200},
      {"film_area_mm2", spec.has_film_area_mm2(), spec.film_area_mm2(), 0, 1e7, true},
      {"activator_ml_per_m2", spec.has_activator_ml_per_m2(), spec.activator_ml_per_m2(), 0, 1000},
      {"soak_s", spec.has_soak_s(), spec.soak_s(), 0, 3600},
      {"activator_wait_s", spec.has_activator_wait_s(), spec.activator_wait_s(), 0, 3600},
      {"activation_window_s", spec.has_activation_window_s(), spec.activation_window_s(), 1, 3600},
      {"water_temperature_c", spec.has_water_temperature_c(), spec.water_temperature_c(), 0, 100}};
  for (const Range& range : ranges) HP_RETURN_IF_ERROR(check_range(range));
  return {};
}

Result<SimulatedDip> read_simulated_dip(const std::string& report) {
  const Json json = Json::parse(report, nullptr, false);
  ReportReader reader(json);
  SimulatedDip out;
  out.depth_mm = reader.number("/depth_mm", 1e-3, 1e6);
  out.speed_mm_per_s = reader.number("/parameters/dip_speed_mm_per_s", 1e-3, 1000);
  out.film_area_mm2 = film_area_mm2(reader);
  const std::string profile = "/parameters/profile/";
  out.activator_ml_per_m2 = reader.number(profile + "activator_ml_per_m2", 0, 1000);
  out.soak_s = reader.number(profile + "soak_s", 0, 3600);
  out.activator_wait_s = reader.number(profile + "activator_wait_s", 0, 3600);
  HP_RETURN_IF_ERROR(reader.status());
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
      plan.warnings.push_back({"deeper_than_simulated",
                               "the dip is deeper than the simulation's " +
                                   text(simulated.depth_mm) +
                                   " mm: what lands beyond that was not computed",
                               spec.simulate_job()});
    }
  }
  fill_from(spec, plan);
  return plan;
}

}  // namespace hydroprint::daemon
