#pragma once

#include <span>
#include <string_view>

#include "hardware/drive/profile.h"
#include "sim/base/result.h"

namespace hydroprint::rig {

/// What is known of one rig's axis and how it may be driven, beside its drive's profile. Positions
/// are the drive's: 0 at home, positive is down. The defaults fit hydroprint-virtual-rig.
struct RigConfig {
  double end_low_mm = -5;  ///< where the end switches are, or else the axis ends
  double end_high_mm = 305;
  double keep_out_mm = 7;  ///< no motion is let closer to an end than this
  double max_speed_mm_per_s = 10;
  double slack_mm = 1;  ///< what the stopping distance may be wrong by
  double poll_period_s = 0.02;
  double following_error_mm = 0.5;  ///< how far the axis may be from where it should be, at rest
  double following_error_s = 0.25;  ///< and this times its speed more
  double arrival_mm = 0.1;          ///< at rest this close to its target, a move is done
  double home_timeout_s = 120;

  bool operator==(const RigConfig&) const = default;
};

/// One member of RigConfig: its name and what it may be.
struct RigConfigKey {
  std::string_view name;
  double RigConfig::*member;
  double least;
  double most;
};

/// All of them, in their order.
[[nodiscard]] std::span<const RigConfigKey> rig_config_keys();

/// Without a clean look at the drive for this long, or this many polls in a row, it counts as lost.
inline constexpr double kStale_s = 0.25;
inline constexpr int kMissedPolls = 3;

/// A jog that nobody asked for again within this time ends.
inline constexpr double kPresence_s = 0.25;

/// Refuses what cannot be driven safely with such a drive, by the key's name ("rig.keep_out_mm"),
/// what it is and what it must be: values out of range or no numbers, a speed that the drive does
/// not have, and a keep-out shorter than the rig's own stopping distance (stopping_distance_mm).
/// @return kInvalidArgument, reason "CONFIG_INVALID"
[[nodiscard]] Status check(const RigConfig& config, const drive::DriveProfile& profile);

}  // namespace hydroprint::rig
