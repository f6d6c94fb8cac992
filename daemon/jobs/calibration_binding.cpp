#include "daemon/jobs/calibration_binding.h"

#include <fmt/format.h>

#include <cmath>

#include "daemon/platform/resource_names.h"
#include "daemon/store/to_proto.h"
#include "proto/warning_message.h"
#include "sim/base/pose_uncertainty.h"

namespace hydroprint::daemon {
namespace {

using Staleness = v1::Calibration::Staleness;

constexpr const char* kActive = "calibrations/active";
// Positions that differ by less count as equal. The axis comes to rest within 0.1 mm of its target.
constexpr double kSamePlace_mm = 0.3;

tl::unexpected<Error> missing(const std::string& name, const std::string& field) {
  return tl::unexpected(Error{
      Code::kFailedPrecondition,
      fmt::format("{}: {} does not exist; calibrate, or name another calibration", field, name),
      ErrorReason::CALIBRATION_MISSING,
      {{"calibration", name}}});
}

std::string words_of(Staleness why, const v1::Calibration& calibration) {
  switch (why) {
    case v1::Calibration::MOVED:
      return fmt::format("the axis has moved since (it was at {:g} mm)", calibration.axis_mm());
    case v1::Calibration::HOMED:
      return "the rig has been homed since, or lost its position";
    default:
      return "an object has been dipped since";
  }
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
  out.ParseFromString(calibration.definition.body);
  out.set_name(calibration_name(calibration.id));
  out.set_kind(static_cast<v1::Calibration::Kind>(calibration.definition.kind));
  out.set_owner(calibration.definition.owner);
  *out.mutable_create_time() = time_of(calibration.create_ms);
  out.set_active(calibration.active);
  if (calibration.definition.job != 0) out.set_job(job_name(calibration.definition.job));
  if (calibration.definition.job != 0 && calibration.definition.kind == CalibrationKind::kObject) {
    out.set_picture(out.job() + "/artifacts/alignment.png");
  }
  add_warnings(pose_warnings(uncertainty_of(out), {OfResource{out.name()}}),
               *out.mutable_warnings());
  if (!calibration.captured) return out;
  const RigPlace& then = calibration.captured->place;
  *out.mutable_capture_time() = time_of(calibration.captured->time_ms);
  for (const Staleness why : staleness(then, now)) out.add_stale(why);
  if (!then.homed) return out;
  out.set_axis_mm(then.axis_mm);
  if (out.has_height_mm()) out.set_contact_mm(then.axis_mm + out.height_mm());
  return out;
}

v1::Pose stated_pose(const v1::Calibration& calibration) {
  v1::Pose out = calibration.pose();
  set_uncertainty(uncertainty_of(calibration), out);
  return out;
}

Result<Calibration> find_calibration(const std::string& name, CalibrationStore& calibrations) {
  if (name != kActive) {
    HP_ASSIGN_OR_RETURN(const std::int64_t id, parse_calibration_name(name));
    return calibrations.get(id);
  }
  HP_ASSIGN_OR_RETURN(auto found, calibrations.active(CalibrationKind::kObject));
  if (found) return std::move(*found);
  return fail(Code::kNotFound,
              "no calibration of an object is active; calibrate, or enter a calibration by hand",
              ErrorReason::CALIBRATION_NOT_FOUND);
}

Result<Calibration> needed_calibration(const std::string& name, const std::string& field,
                                       CalibrationStore& calibrations) {
  auto found = find_calibration(name, calibrations);
  if (!found && found.error().reason == ErrorReason::CALIBRATION_NOT_FOUND)
    return missing(name, field);
  if (found && found->definition.kind != CalibrationKind::kObject) {
    return invalid_field(field,
                         "names the calibration of a camera; name the calibration of an object");
  }
  return found;
}

void Objection::add(const std::string& why, const std::string& name) {
  words += (words.empty() ? "" : ", and ") + why;
  names += (names.empty() ? "" : ",") + name;
}

Objection objection(const v1::Calibration& calibration, const v1::InputFile& mesh) {
  Objection out;
  for (const int why : calibration.stale()) {
    const auto stale = static_cast<Staleness>(why);
    out.add(words_of(stale, calibration), v1::Calibration::Staleness_Name(stale));
  }
  if (!mesh.asset().empty() && mesh.asset() != calibration.mesh().asset()) {
    out.add(
        fmt::format("the calibration belongs to another object ({})", calibration.mesh().name()),
        "OTHER_OBJECT");
  }
  return out;
}

Status check_objection(const v1::Calibration& calibration, const Objection& objection,
                       bool is_allowed) {
  if (objection.words.empty() || is_allowed) return {};
  return tl::unexpected(Error{
      Code::kFailedPrecondition,
      fmt::format("{} is no longer valid: {}; calibrate again, or set allow_stale_calibration",
                  calibration.name(), objection.words),
      ErrorReason::CALIBRATION_STALE,
      {{"calibration", calibration.name()}, {"why", objection.names}}});
}

bool knows_contact(const v1::Calibration& calibration) {
  for (const int why : calibration.stale()) {
    if (why != v1::Calibration::MOVED) return false;
  }
  return calibration.has_contact_mm();
}

}  // namespace hydroprint::daemon
