#pragma once

#include <optional>
#include <string>

#include "daemon/jobs/kind.h"
#include "hydroprint/v1/calibration_service.pb.h"
#include "hydroprint/v1/spec.pb.h"

namespace hydroprint::daemon {

/// Fills a spec that names one dip of a plan: object, picture, scale and film from the plan; pose,
/// profile, resolution, model, depth and speed unless the spec sets them. Errors:
/// those of earlier_job(); SPEC_INVALID, naming the field, for another mesh and for a dip that the
/// plan does not have; STATE_FORBIDS for a plan without its files.
[[nodiscard]] Status take_plan(v1::SimulateSpec& spec, const JobSources& sources);

/// A property in which a calibration differs from a plan: "scale 2" instead of "1".
struct CalibrationMismatch {
  std::string own;
  std::string planned;
};

/// Compares scale and film of a calibration with those of a plan.
/// @param scale  nullopt: the default, 1 mm
/// @param film   as in SimulateSpec.film; empty: the default, A4
/// @return nullopt if the calibration can serve the plan
[[nodiscard]] std::optional<CalibrationMismatch> mismatch(const v1::Calibration& calibration,
                                                          std::optional<double> scale,
                                                          const std::string& film);

/// Adds the plan's files to a spec and removes the plan's name.
[[nodiscard]] Status adopt_plan(v1::SimulateSpec& spec, const JobSources& sources);

}  // namespace hydroprint::daemon
