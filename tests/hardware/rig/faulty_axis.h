#pragma once

#include <optional>
#include <random>
#include <string>
#include <vector>

#include "hardware/rig/state.h"

namespace hydroprint::rig {

/// What the rig does when a fault begins.
enum class Doing { kUnhomed, kIdle, kHome, kJog, kMove, kDip, kStopping };

/// A fault of an axis or of its drive.
enum class AxisFault {
  kNone,
  kRunaway,           ///< moves at 25 mm/s, away from home
  kFastRunaway,       ///< moves at 5 times the drive's highest speed
  kHiddenRunaway,     ///< as kRunaway, while the velocity register shows 0
  kFrozenRunaway,     ///< moves at 5 mm/s, while the position register does not change
  kDrift,             ///< moves at 0.15 mm/s
  kZeroed,            ///< the drive sets its position to zero
  kPositionFrozen,    ///< the position register does not change
  kVelocityFrozen,    ///< the velocity register shows 0
  kWrongWay,          ///< moves at the ordered speed, the wrong way
  kStalled,           ///< stands still
  kTwiceAsFast,       ///< moves at twice the ordered speed
  kNotANumber,        ///< the position is NaN
  kHomedBitStale,     ///< homing ends at once, because the drive's homed bit was set before
  kHomedElsewhere,    ///< homing ends at 80 mm
  kHomeSwitchBroken,  ///< homing does not find the switch
  kStopIgnored,       ///< the drive acknowledges the stop and goes on at its speed
};

/// A row of the table of faults: a fault in a state, the cause to be named, and how soon.
struct FaultRow {
  Doing doing;
  AxisFault fault;
  Cause cause;           ///< in the report
  double within_s;       ///< noticed within this time ...
  double within_mm = 1;  ///< ... or this distance, whichever is later; 0: only the time counts
};
[[nodiscard]] const std::vector<FaultRow>& fault_table();

/// The table as in README.md.
[[nodiscard]] std::string fault_table_markdown();

/// What observation and supervision made of an axis.
struct Noticed {
  Cause cause = Cause::kNone;
  double after_s = 0;    ///< since the fault began
  double after_mm = 0;   ///< distance that the axis moved since then
  bool is_done = false;  ///< the motion ended as ordered
};

/// Plays an axis with noisy samples at irregular times, 20 ms apart in the mean, to AxisObserver
/// and MotionSupervisor, as the control loop does. Without a velocity register, velocities are
/// derived from positions, as hydroprint::drive::Drive does.
[[nodiscard]] Noticed play(Doing doing, AxisFault fault, unsigned seed,
                           bool has_velocity_register = true);

[[nodiscard]] std::string_view words(Doing doing);
[[nodiscard]] std::string_view words(AxisFault fault);

}  // namespace hydroprint::rig
