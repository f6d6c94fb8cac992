#include "daemon/calibration_use.h"

#include <cmath>
#include <sstream>

#include "daemon/convert.h"
#include "daemon/earlier_job.h"
#include "daemon/names.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::daemon {
namespace {

using Staleness = v1::Calibration::Staleness;

constexpr const char* kActive = "calibrations/active";
// The axis comes to rest within a tenth of a millimetre of where it is sent.
constexpr double kSamePlace_mm = 0.3;

std::string text(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

tl::unexpected<Error> missing(const std::string& name, const std::string& field) {
  return tl::unexpected(Error{Code::kFailedPrecondition,
                              field + ": " + name + " is not there; calibrate, or name another one",
                              "CALIBRATION_MISSING",
                              {{"calibration", name}}});
}

/// As find_calibration(), for a job that needs it.
Result<Calibration> needed(const std::string& name, const std::string& field,
                           CalibrationStore& calibrations) {
  auto found = find_calibration(name, calibrations);
  if (!found && found.error().reason == "CALIBRATION_NOT_FOUND") return missing(name, field);
  if (found && found->made.kind != CalibrationKind::kObject) {
    return invalid_field(field, "names the calibration of a camera; name one of an object");
  }
  return found;
}

v1::SimulateSpec simulation(const Job& job) {
  v1::Job body;
  body.ParseFromString(job.made.body);
  return body.simulate();
}

Result<v1::SimulateSpec> simulation_of(const v1::DipSpec& spec, JobStore& jobs) {
  if (spec.simulate_job().empty()) return v1::SimulateSpec();
  HP_ASSIGN_OR_RETURN(const Job job,
                      earlier_job(spec.simulate_job(), "simulate", "dip.simulate_job", jobs));
  return simulation(job);
}

std::string words_of(Staleness why, const v1::Calibration& calibration) {
  switch (why) {
    case v1::Calibration::MOVED:
      return "the axis is not where it was then (" + text(calibration.axis_mm()) + " mm)";
    case v1::Calibration::HOMED:
      return "the rig was homed since, or lost its place";
    default:
      return "something was dipped since";
  }
}

/// Why a calibration may not be used for this mesh now, in words and as names; empty if it may.
struct Objection {
  std::string words, names;
  void add(const std::string& why, const std::string& name) {
    words += (words.empty() ? "" : ", and ") + why;
    names += (names.empty() ? "" : ",") + name;
  }
};

Objection objection(const v1::Calibration& calibration, const v1::InputFile& mesh) {
  Objection out;
  for (const int why : calibration.stale()) {
    const auto stale = static_cast<Staleness>(why);
    out.add(words_of(stale, calibration), v1::Calibration::Staleness_Name(stale));
  }
  if (!mesh.asset().empty() && mesh.asset() != calibration.mesh().asset()) {
    out.add("it is of another object (" + calibration.mesh().name() + ")", "OTHER_OBJECT");
  }
  return out;
}

Status check(const v1::Calibration& calibration, const Objection& objection, bool is_allowed) {
  if (objection.words.empty() || is_allowed) return {};
  return tl::unexpected(Error{Code::kFailedPrecondition,
                              calibration.name() + " does not hold any more: " + objection.words +
                                  "; calibrate again, or say allow_stale_calibration",
                              "CALIBRATION_STALE",
                              {{"calibration", calibration.name()}, {"why", objection.names}}});
}

tl::unexpected<Error> taken(const std::string& field) {
  return invalid_field(field, "is taken from the calibration; leave one of the two out");
}

/// Whether the axis still counts from where it did, with the same object on it.
bool knows_contact(const v1::Calibration& calibration) {
  for (const int why : calibration.stale()) {
    if (why != v1::Calibration::MOVED) return false;
  }
  return calibration.has_contact_mm();
}

void add_polygon(const v1::InputFile& polygon, v1::SimulateSpec& spec) {
  for (const v1::InputFile& file : spec.extra_files()) {
    if (file.name() == polygon.name() && file.asset() == polygon.asset()) return;
  }
  *spec.add_extra_files() = polygon;
}

}  // namespace

std::vector<Staleness> staleness(const RigPlace& then, const RigPlace& now) {
  std::vector<Staleness> out;
  if (!then.watched) return out;
  if (then.homings != now.homings || then.homed != now.homed || !now.watched) {
    out.push_back(v1::Calibration::HOMED);
  } else if (then.homed && !(std::abs(then.axis_mm - now.axis_mm) <= kSamePlace_mm)) {
    out.push_back(v1::Calibration::MOVED);
  }
  if (then.dips != now.dips && now.watched) out.push_back(v1::Calibration::DIPPED);
  return out;
}

v1::Calibration to_message(const Calibration& calibration, const RigPlace& now) {
  v1::Calibration out;
  out.ParseFromString(calibration.made.body);
  out.set_name(calibration_name(calibration.id));
  out.set_kind(static_cast<v1::Calibration::Kind>(calibration.made.kind));
  out.set_owner(calibration.made.owner);
  *out.mutable_create_time() = time_of(calibration.create_ms);
  out.set_active(calibration.active);
  if (calibration.made.job != 0) out.set_job(job_name(calibration.made.job));
  if (calibration.made.job != 0 && calibration.made.kind == CalibrationKind::kObject) {
    out.set_picture(out.job() + "/artifacts/alignment.png");
  }
  if (!calibration.captured) return out;
  const RigPlace& then = calibration.captured->place;
  *out.mutable_capture_time() = time_of(calibration.captured->time_ms);
  for (const Staleness why : staleness(then, now)) out.add_stale(why);
  if (!then.homed) return out;
  out.set_axis_mm(then.axis_mm);
  if (out.has_height_mm()) out.set_contact_mm(then.axis_mm + out.height_mm());
  return out;
}

Result<Calibration> find_calibration(const std::string& name, CalibrationStore& calibrations) {
  if (name != kActive) {
    HP_ASSIGN_OR_RETURN(const std::int64_t id, parse_calibration_name(name));
    return calibrations.get(id);
  }
  HP_ASSIGN_OR_RETURN(auto found, calibrations.active(CalibrationKind::kObject));
  if (found) return std::move(*found);
  return fail(Code::kNotFound, "no calibration of an object is active", "CALIBRATION_NOT_FOUND");
}

Result<v1::Job> with_named_calibration(const v1::Job& job, JobStore& jobs,
                                       CalibrationStore& calibrations) {
  v1::Job out = job;
  if (!job.simulate().calibration().empty()) {
    HP_ASSIGN_OR_RETURN(const Calibration found,
                        needed(job.simulate().calibration(), "simulate.calibration", calibrations));
    out.mutable_simulate()->set_calibration(calibration_name(found.id));
  }
  if (!job.has_dip()) return out;
  HP_ASSIGN_OR_RETURN(const v1::SimulateSpec simulated, simulation_of(job.dip(), jobs));
  const std::string name =
      job.dip().calibration().empty() ? simulated.calibration() : job.dip().calibration();
  if (name.empty()) return out;
  HP_ASSIGN_OR_RETURN(const Calibration found, needed(name, "dip.calibration", calibrations));
  out.mutable_dip()->set_calibration(calibration_name(found.id));
  if (!simulated.calibration().empty() && simulated.calibration() != out.dip().calibration()) {
    return invalid_field("dip.calibration", "is not the one that " + job.dip().simulate_job() +
                                                " was made with (" + simulated.calibration() +
                                                "); leave it out, or simulate again");
  }
  return out;
}

Result<v1::Job> with_calibration(const v1::Job& job, CalibrationStore& calibrations,
                                 const RigPlace& now) {
  v1::Job out = job;
  if (job.simulate().calibration().empty()) return out;
  v1::SimulateSpec& spec = *out.mutable_simulate();
  if (spec.has_pose()) return taken("simulate.pose");
  if (spec.has_film()) return taken("simulate.film");
  if (spec.has_scale()) return taken("simulate.scale");
  HP_ASSIGN_OR_RETURN(const Calibration found,
                      needed(spec.calibration(), "simulate.calibration", calibrations));
  const v1::Calibration calibration = to_message(found, now);
  HP_RETURN_IF_ERROR(
      check(calibration, objection(calibration, spec.mesh()), spec.allow_stale_calibration()));
  *spec.mutable_pose() = calibration.pose();
  spec.set_scale(calibration.scale());
  if (!calibration.film().empty()) spec.set_film(calibration.film());
  if (calibration.has_film_file()) add_polygon(calibration.film_file(), spec);
  return out;
}

Status go_by_calibration(const v1::Job& job, JobStore& jobs, CalibrationStore& calibrations,
                         const RigPlace& now, dip::Plan& plan) {
  const v1::DipSpec& spec = job.dip();
  if (spec.calibration().empty()) return {};
  HP_ASSIGN_OR_RETURN(const Calibration found,
                      needed(spec.calibration(), "dip.calibration", calibrations));
  HP_ASSIGN_OR_RETURN(const v1::SimulateSpec simulated, simulation_of(spec, jobs));
  const v1::Calibration calibration = to_message(found, now);
  const Objection why = objection(calibration, simulated.mesh());
  HP_RETURN_IF_ERROR(check(calibration, why, spec.allow_stale_calibration()));
  plan.calibration = calibration.name();
  if (!why.words.empty()) {
    plan.warnings.push_back({"calibration_stale",
                             calibration.name() + " does not hold any more: " + why.words,
                             calibration.name()});
  }
  if (!spec.simulate_job().empty() && simulated.calibration().empty()) {
    plan.warnings.push_back({"pose_not_simulated",
                             spec.simulate_job() + " was not made for the pose of " +
                                 calibration.name() + ": what is printed may not fit",
                             spec.simulate_job()});
  }
  if (!knows_contact(calibration)) return {};
  plan.contact_mm = calibration.contact_mm();
  plan.homings = found.captured->place.homings;
  return {};
}

}  // namespace hydroprint::daemon
