#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "daemon/dip/state_machine.h"
#include "hardware/drive/profile.h"
#include "hardware/rig/config.h"
#include "hardware/rig/motion_supervisor.h"
#include "sim/base/result.h"

namespace hydroprint::dip {

/// All parameters of a dip, fixed before it begins; see hydroprint.v1.DipSpec.
struct Plan {
  std::string simulate_job;  ///< "jobs/3"; empty: none
  double depth_mm = 0;       ///< distance below first contact
  double speed_mm_per_s = 5;
  double hold_s = 2;
  double retract_speed_mm_per_s = 5;
  double clearance_mm = 20;  ///< distance above first contact, where the descent begins
  double film_area_mm2 = 210.0 * 297.0;
  double activator_ml_per_m2 = 16;
  Clocks clocks;
  std::optional<double> water_temperature_c;
  std::string calibration;  ///< "calibrations/3"; empty: none
  /// Position of first contact from the calibration; nullopt: the operator finds it.
  std::optional<double> contact_mm;
  std::int64_t homings = 0;  ///< the rig's number of homings (RigPlace) at the calibration
  int immersion = 0;         ///< which dip of a plan of several dips, from 1; 0: none
  int immersions = 0;        ///< number of dips of that plan
  std::string plan_job;      ///< "jobs/2"; empty: not known
  Warnings warnings;         ///< reasons to expect a poor print
  /// The pose of film or object is uncertain (pose_warnings()): the first step asks whether to go
  /// on.
  bool has_uncertain_pose = false;

  /// Returns the amount of activator for the film.
  [[nodiscard]] double activator_ml() const { return film_area_mm2 * 1e-6 * activator_ml_per_m2; }
};

/// Minimum clearance above first contact.
inline constexpr double kLeastClearance_mm = 1;

/// Positions of the axis for a dip; positive is down.
struct Ways {
  double clear_mm = 0;   ///< position above the water, where the descent begins
  double bottom_mm = 0;  ///< position at full depth
  double up_mm = 0;  ///< end of the retraction: clear_mm, or the loading position if that is higher
};

/// Checks that the speeds and the depth are within the rig's limits. Errors: kOutOfRange,
/// LIMIT_EXCEEDED.
[[nodiscard]] Status check(const Plan& plan, const rig::RigConfig& config);

/// Computes the positions for a given first contact. The clearance is reduced if the soft limit is
/// closer.
/// @return kOutOfRange, LIMIT_EXCEEDED (metadata axis, min, max, value) if the depth, or the
///         required distance above first contact, is out of reach
[[nodiscard]] Result<Ways> ways_from(const Plan& plan, double contact_mm, double loaded_mm,
                                     const rig::RigConfig& config,
                                     const drive::DriveProfile& profile);

/// Return the motion of step CLEAR, and the motions of steps DESCEND, HOLD and RETRACT.
[[nodiscard]] rig::Leg rise(const Plan& plan, const Ways& ways);
[[nodiscard]] std::vector<rig::Leg> legs(const Plan& plan, const Ways& ways);

/// Returns the planned duration of a step in s; 0 for steps that wait for the operator.
/// @param ways  nullopt while first contact is unknown; the duration is then an estimate
[[nodiscard]] double planned_s(Step step, const Plan& plan, const std::optional<Ways>& ways,
                               double acceleration_mm_per_s2);

/// Progress of a dip, and its earliest end.
struct ProgressEstimate {
  double fraction = 0;       ///< progress of the whole dip, [0, 1]
  double step_fraction = 0;  ///< progress of the step, [0, 1]
  double remaining_s = 0;    ///< time left if the operator confirms without delay
};
[[nodiscard]] ProgressEstimate estimate_progress(const Stand& stand, double time_s,
                                                 const Plan& plan, const std::optional<Ways>& ways,
                                                 double acceleration_mm_per_s2);

}  // namespace hydroprint::dip
