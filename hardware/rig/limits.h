#pragma once

#include "hardware/drive/profile.h"
#include "hardware/rig/config.h"
#include "sim/base/result.h"

namespace hydroprint::rig {

/// How far the axis goes on at worst once it should stop: what is driven until the lost link is
/// noticed and until the drive's watchdog (at its longest) acts, braking, and slack,
/// v (kStale_s + T_watchdog) + v^2 / (2 a) + slack.
[[nodiscard]] double stopping_distance_mm(const RigConfig& config,
                                          const drive::DriveProfile& profile,
                                          double speed_mm_per_s);

/// When the axis is at rest at the latest after the last clean look, if the link is lost:
/// kStale_s + T_watchdog + v / a at the highest speed.
[[nodiscard]] double stopping_time_s(const RigConfig& config, const drive::DriveProfile& profile);

struct Range {
  double low_mm;
  double high_mm;
};

/// Where the axis may be driven: between the ends, less the keep-out at both.
[[nodiscard]] Range soft_limits(const RigConfig& config);

/// Refuse a motion to a place outside the soft limits, or at a speed not in (0, max_speed].
/// @return kOutOfRange, reason "LIMIT_EXCEEDED"; metadata axis, min, max, value (mm, mm/s)
[[nodiscard]] Status check_target(const RigConfig& config, double target_mm);
[[nodiscard]] Status check_speed(const RigConfig& config, double speed_mm_per_s);

/// While it moves: true if the axis is outside the soft limits by more than the slack and further
/// out than where it started. (A homed axis may rest outside; from there it may only come in.)
[[nodiscard]] bool outside_limits(const RigConfig& config, double position_mm, double start_mm);

/// True if a jog at this speed (of either sign) may go on: there is room for a few more looks and
/// for braking before the soft limit ahead.
[[nodiscard]] bool may_jog(const RigConfig& config, const drive::DriveProfile& profile,
                           double position_mm, double speed_mm_per_s);

/// How far the axis may be from where it should be at this speed (LinuxCNC's FERROR).
[[nodiscard]] double following_band_mm(const RigConfig& config, double speed_mm_per_s);

}  // namespace hydroprint::rig
