#pragma once

#include <string>

#include "hardware/drive/profile.h"
#include "hardware/rig/config.h"
#include "sim/base/result.h"

namespace hydroprint::rig {

/// Largest distance from the decision to stop until standstill. Covers the time until the lost link
/// is noticed, the longest watchdog time, braking and slack: v (kStale_s + T_watchdog) + v^2 / (2
/// a) + slack.
[[nodiscard]] double stopping_distance_mm(const RigConfig& config,
                                          const drive::DriveProfile& profile,
                                          double speed_mm_per_s);

/// Latest time of standstill after the last valid poll, if the link is lost: kStale_s + T_watchdog
/// + v / a at the highest speed.
[[nodiscard]] double stopping_time_s(const RigConfig& config, const drive::DriveProfile& profile);

struct Range {
  double low_mm;
  double high_mm;
};

/// Allowed range of the axis: between the ends, less the keep-out at both.
[[nodiscard]] Range soft_limits(const RigConfig& config);

/// @return kOutOfRange, reason "LIMIT_EXCEEDED"; metadata axis, min, max, value (mm, mm/s)
[[nodiscard]] tl::unexpected<Error> limit_exceeded(const std::string& axis, std::string message,
                                                   double value, Range range);

/// Refuse a target outside the soft limits, or a speed not in (0, max_speed], with
/// limit_exceeded().
[[nodiscard]] Status check_target(const RigConfig& config, double target_mm);
[[nodiscard]] Status check_speed(const RigConfig& config, double speed_mm_per_s);

/// During a motion: whether the axis is outside the soft limits by more than the slack and farther
/// out than at its start. (A homed axis may rest outside; from there it may only move inwards.)
[[nodiscard]] bool outside_limits(const RigConfig& config, double position_mm, double start_mm);

/// Whether a jog at this speed (of either sign) may continue: there must be room for a few more
/// polls and for braking before the soft limit ahead.
[[nodiscard]] bool may_jog(const RigConfig& config, const drive::DriveProfile& profile,
                           double position_mm, double speed_mm_per_s);

/// Allowed deviation from the expected position at this speed (LinuxCNC's FERROR).
[[nodiscard]] double following_band_mm(const RigConfig& config, double speed_mm_per_s);

}  // namespace hydroprint::rig
