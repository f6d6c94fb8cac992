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

/// Everything that is decided about a dip before it begins; see hydroprint.v1.DipSpec.
struct Plan {
  std::string simulate_job;  ///< "jobs/3"; empty: none
  double depth_mm = 0;       ///< below first contact
  double speed_mm_per_s = 5;
  double hold_s = 2;
  double retract_speed_mm_per_s = 5;
  double clearance_mm = 20;  ///< above first contact
  double film_area_mm2 = 210.0 * 297.0;
  double activator_ml_per_m2 = 16;
  Clocks clocks;
  std::optional<double> water_temperature_c;
  std::string calibration;           ///< "calibrations/3"; empty: none
  std::optional<double> contact_mm;  ///< where first contact is, by that; none: somebody looks
  std::int64_t homings = 0;          ///< of the rig, when that was measured
  Warnings warnings;                 ///< that speak against a good print

  /// How much activator the film wants.
  [[nodiscard]] double activator_ml() const { return film_area_mm2 * 1e-6 * activator_ml_per_m2; }
};

/// The room above first contact that a dip needs at least.
inline constexpr double kLeastClearance_mm = 1;

/// Where the axis goes; positions are the axis's, positive is down.
struct Ways {
  double clear_mm = 0;   ///< above the water, where the descent begins
  double bottom_mm = 0;  ///< at the depth
  double up_mm = 0;  ///< where the retraction ends: where the object was loaded, or the clearance
};

/// What a dip asks of any rig: speeds and a depth within its limits. kOutOfRange, LIMIT_EXCEEDED.
[[nodiscard]] Status check(const Plan& plan, const rig::RigConfig& config);

/// The ways from a first contact. The clearance is less where the soft limit is nearer.
/// @return kOutOfRange, LIMIT_EXCEEDED (metadata axis, min, max, value) if the depth, or the room
///   that is needed above first contact, is out of reach
[[nodiscard]] Result<Ways> ways_from(const Plan& plan, double contact_mm, double loaded_mm,
                                     const rig::RigConfig& config,
                                     const drive::DriveProfile& profile);

/// The motions of CLEAR, and of DESCEND, HOLD and RETRACT.
[[nodiscard]] rig::Leg rise(const Plan& plan, const Ways& ways);
[[nodiscard]] std::vector<rig::Leg> legs(const Plan& plan, const Ways& ways);

/// How long a step will take, s; those that wait for the operator 0.
/// @param ways  none while first contact is not known: then a guess
[[nodiscard]] double planned_s(Step step, const Plan& plan, const std::optional<Ways>& ways,
                               double acceleration_mm_per_s2);

/// How far a dip is, and when it can be done at the earliest.
struct Outlook {
  double fraction = 0;       ///< of the whole, [0, 1]
  double step_fraction = 0;  ///< of the step, [0, 1]
  double remaining_s = 0;    ///< if no operator takes any time
};
[[nodiscard]] Outlook outlook(const Stand& stand, double time_s, const Plan& plan,
                              const std::optional<Ways>& ways, double acceleration_mm_per_s2);

}  // namespace hydroprint::dip
