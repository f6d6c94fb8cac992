#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/calibration_store.h"
#include "daemon/dip/plan.h"
#include "daemon/job_store.h"
#include "daemon/rig_place.h"
#include "hydroprint/v1/calibration_service.pb.h"

namespace hydroprint::v1 {
class Job;
}

namespace hydroprint::daemon {

/// A calibration as the API has it, and whether it still holds with the rig as it is now.
[[nodiscard]] v1::Calibration to_message(const Calibration& calibration, const RigPlace& now);

/// Why what was seen then does not hold any more.
[[nodiscard]] std::vector<v1::Calibration::Staleness> staleness(const RigPlace& then,
                                                                const RigPlace& now);

/// "calibrations/3", "calibrations/active" (the active one of an object). ID_INVALID,
/// CALIBRATION_NOT_FOUND.
[[nodiscard]] Result<Calibration> find_calibration(const std::string& name,
                                                   CalibrationStore& calibrations);

/// A simulate or dip job with the name of the calibration that it goes by in place of
/// "calibrations/active", and a dip with that of its simulation if it names none.
/// @return ID_INVALID, CALIBRATION_MISSING; SPEC_INVALID for a dip that names another one than its
///   simulation; what earlier_job() refuses
[[nodiscard]] Result<v1::Job> with_named_calibration(const v1::Job& job, JobStore& jobs,
                                                     CalibrationStore& calibrations);

/// A simulate job with pose, film and scale of its calibration filled in; others as they are.
/// @return SPEC_INVALID if what is to be taken is given, too; CALIBRATION_MISSING,
/// CALIBRATION_STALE
[[nodiscard]] Result<v1::Job> with_calibration(const v1::Job& job, CalibrationStore& calibrations,
                                               const RigPlace& now);

/// Has a dip go by its calibration, if it names one: first contact is where that says.
/// @return as with_calibration()
[[nodiscard]] Status go_by_calibration(const v1::Job& job, JobStore& jobs,
                                       CalibrationStore& calibrations, const RigPlace& now,
                                       dip::Plan& plan);

}  // namespace hydroprint::daemon
