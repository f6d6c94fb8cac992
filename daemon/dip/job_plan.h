#pragma once

#include "daemon/dip/plan.h"
#include "daemon/store/calibration_store.h"
#include "daemon/store/job_store.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::v1 {
class DipSpec;
}

namespace hydroprint::daemon {

/// What a simulation says of the dip it was made for, from its report.json.
struct SimulatedDip {
  double depth_mm = 0;
  double speed_mm_per_s = 0;
  double film_area_mm2 = 0;
  double activator_ml_per_m2 = 0;
  double soak_s = 0;
  double activator_wait_s = 0;
};

/// Reads that of a report, trusting nothing in it.
/// @return kFailedPrecondition, STATE_FORBIDS, naming the key that is missing or out of range
[[nodiscard]] Result<SimulatedDip> read_simulated_dip(const std::string& report);

/// The plan of a checked spec, its gaps filled from its simulate job and the defaults.
/// @return JOB_NOT_FOUND; STATE_FORBIDS if that job did not succeed or left no usable report;
///   SPEC_INVALID if it is no simulate job
[[nodiscard]] Result<dip::Plan> plan_of(const v1::DipSpec& spec, JobStore& jobs,
                                        const Layout& layout);

/// Has a dip go by its calibration, if it names one: first contact is where that says.
/// @return CALIBRATION_MISSING, CALIBRATION_STALE, what earlier_simulation() refuses
[[nodiscard]] Status go_by_calibration(const v1::DipSpec& spec, JobStore& jobs,
                                       CalibrationStore& calibrations, const RigPlace& now,
                                       dip::Plan& plan);

}  // namespace hydroprint::daemon
