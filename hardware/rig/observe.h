#pragma once

#include <optional>
#include <span>

#include "hardware/drive/profile.h"
#include "hardware/rig/config.h"
#include "hardware/rig/samples.h"
#include "hardware/rig/state.h"

namespace hydroprint::rig {

/// What observation needs of one valid poll.
struct AxisSample {
  TimePoint time;           ///< of the position
  double time_error_s = 0;  ///< uncertainty of `time`
  double position_mm = 0;
  double velocity_mm_per_s = 0;  ///< as reported by the drive
};

/// What the axis is ordered to do, as far as observation depends on it.
struct AxisOrder {
  State state = State::kOffline;
  Motion motion = Motion::kNone;
  /// When the state began; in a motion: when its speed was last ordered.
  TimePoint since = {};
  double from_mm = 0;                     ///< at rest: position at `since`
  double speed_mm_per_s = 0;              ///< signed, except for homing, which may go either way
  double entry_mm_per_s = 0;              ///< bound of the speed at `since`, of an earlier order
  TimePoint turned = {};                  ///< since then, the direction is that of `speed_mm_per_s`
  std::optional<TimePoint> stopped = {};  ///< STOPPING: when the drive acknowledged the stop
};

/// How long samples are observed. Slow disagreement adds up over this time.
inline constexpr double kObserved_s = 4;

/// Compares the samples with the order, and position with velocity; returns the fault that they
/// show. Modelled on the monitoring functions of IEC 61800-5-2; README.md lists the rules.
/// - at rest (UNHOMED, IDLE): the position stays within `standstill_mm` (SOS);
/// - jog, move, dip, homing: the speed stays below that ordered (SLS); not back
///   (SDI, not for homing); a jog makes progress;
/// - in a motion: position and velocity agree (not without a velocity register);
/// - always: the position does not jump;
/// - STOPPING: the axis slows down once the drive has acknowledged the stop.
/// Targets of moves, limits, and where homing ends are checked by MotionSupervisor.
/// @param samples  oldest first, of one connection and one home position, at most kObserved_s old
[[nodiscard]] std::optional<Cause> observe(const RigConfig& config,
                                           const drive::DriveProfile& profile,
                                           const AxisOrder& order,
                                           std::span<const AxisSample> samples);

/// Returns the highest speed that an order allows at a time: that of an earlier order decays.
[[nodiscard]] double speed_bound_mm_per_s(const drive::DriveProfile& profile,
                                          const AxisOrder& order, TimePoint now);

/// Returns whether the last sample shows a position that the axis could not reach since the one
/// before. One further sample decides between a jump and motion, so nothing else should be
/// concluded from this position.
[[nodiscard]] bool is_in_doubt(const drive::DriveProfile& profile,
                               std::span<const AxisSample> samples);

}  // namespace hydroprint::rig
