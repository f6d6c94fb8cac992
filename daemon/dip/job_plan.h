#pragma once

#include "daemon/dip/plan.h"
#include "daemon/store/calibration_store.h"
#include "daemon/store/job_store.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::v1 {
class DipSpec;
class SimulateReport;
}  // namespace hydroprint::v1

namespace hydroprint::daemon {

/// Parameters that a simulation assumed for the dip, from its report.json.
struct SimulatedDip {
  double depth_mm = 0;
  double speed_mm_per_s = 0;
  double film_area_mm2 = 0;
  double activator_ml_per_m2 = 0;
  double soak_s = 0;
  double activator_wait_s = 0;
  int immersion = 0;   ///< which dip of a plan, from 1; 0: none
  int immersions = 0;  ///< number of dips of that plan
  Warnings warnings;   ///< about differences from that plan
};

/// Takes the parameters from an untrusted report.
/// @return kFailedPrecondition, STATE_FORBIDS, naming the value that is out of range
[[nodiscard]] Result<SimulatedDip> read_simulated_dip(const v1::SimulateReport& report);

/// Creates the plan of a checked spec; missing values come from its simulate job and the defaults.
/// @return JOB_NOT_FOUND; STATE_FORBIDS if that job did not succeed or has no usable report;
///         SPEC_INVALID if it is not a simulate job
[[nodiscard]] Result<dip::Plan> plan_of(const v1::DipSpec& spec, JobStore& jobs,
                                        const Layout& layout);

/// Applies the calibration named in a dip's spec, if any, which determines the position of first
/// contact. Adds the warnings of pose_warnings() for the poses of the simulation and the
/// calibration.
/// @return CALIBRATION_MISSING, CALIBRATION_STALE, errors of earlier_simulation()
[[nodiscard]] Status go_by_calibration(const v1::DipSpec& spec, JobStore& jobs,
                                       CalibrationStore& calibrations, const RigPlace& now,
                                       dip::Plan& plan);

}  // namespace hydroprint::daemon
