#pragma once

#include <string>

#include "hardware/drive/profile.h"
#include "hardware/rig/config.h"
#include "sim/base/result.h"

namespace hydroprint::rig {

/// Returns the largest distance between the decision to stop and standstill. Includes the time
/// until the lost link is noticed, the longest watchdog time, braking and slack: v (kStale_s +
/// T_watchdog) + v^2 / (2 a) + slack.
[[nodiscard]] double stopping_distance_mm(const RigConfig& config,
                                          const drive::DriveProfile& profile,
                                          double speed_mm_per_s);

/// Returns the longest time between the last valid poll and standstill if the link is lost:
/// kStale_s + T_watchdog + v / a at the highest speed.
[[nodiscard]] double stopping_time_s(const RigConfig& config, const drive::DriveProfile& profile);

struct Range {
  double low_mm;
  double high_mm;
};

/// Returns the allowed range of the axis: between its ends, less the keep-out distance at each end.
[[nodiscard]] Range soft_limits(const RigConfig& config);

/// Returns kOutOfRange, reason LIMIT_EXCEEDED, with metadata axis, min, max, value (in mm or mm/s).
/// @param axis  "position" or "speed"
[[nodiscard]] tl::unexpected<Error> limit_exceeded(const std::string& axis, std::string message,
                                                   double value, Range range);

/// Refuse a target outside the soft limits, or a speed not in (0, max_speed], with
/// limit_exceeded().
[[nodiscard]] Status check_target(const RigConfig& config, double target_mm);
[[nodiscard]] Status check_speed(const RigConfig& config, double speed_mm_per_s);

/// Returns whether the axis, during a motion, is outside the soft limits by more than the slack and
/// farther out than at its start. (A homed axis may rest outside the limits; then it may only move
/// inwards.)
[[nodiscard]] bool outside_limits(const RigConfig& config, double position_mm, double start_mm);

/// Returns whether a jog at this speed (of either sign) may continue: there must be space for a few
/// more polls and for braking before the soft limit ahead.
[[nodiscard]] bool may_jog(const RigConfig& config, const drive::DriveProfile& profile,
                           double position_mm, double speed_mm_per_s);

/// Returns the allowed deviation from the expected position at this speed (LinuxCNC's FERROR).
[[nodiscard]] double following_band_mm(const RigConfig& config, double speed_mm_per_s);

}  // namespace hydroprint::rig
