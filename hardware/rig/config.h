#pragma once

#include <span>
#include <string_view>

#include "hardware/drive/link_budget.h"
#include "hardware/drive/profile.h"
#include "sim/base/result.h"

namespace hydroprint::rig {

/// Configuration of a rig's axis and its limits, in addition to the drive's profile. Positions are
/// those of the drive: 0 at the home switch, positive is down. The defaults fit
/// hydroprint-virtual-rig.
struct RigConfig {
  double end_low_mm = -5;  ///< limit switches, or else the ends of the axis; low is the top
  double end_high_mm = 305;
  double keep_out_mm = 7;  ///< minimum distance of all motion from the ends
  double max_speed_mm_per_s = 10;
  double slack_mm = 1;  ///< tolerance in the stopping distance
  double poll_period_s = 0.02;
  double following_error_mm = 0.5;  ///< largest deviation from the expected position at speed 0
  double following_error_s = 0.25;  ///< additional deviation, per mm/s of speed
  double standstill_mm = 0.5;       ///< largest deviation of an axis at rest
  double arrival_mm = 0.1;          ///< largest distance from the target at the end of a move
  double home_timeout_s = 120;

  bool operator==(const RigConfig&) const = default;
};

/// A configuration key: member of RigConfig, name and range.
struct RigConfigKey {
  std::string_view name;
  double RigConfig::*member;
  double least;
  double most;
};

/// Returns all keys, in order.
[[nodiscard]] std::span<const RigConfigKey> rig_config_keys();

/// The link to the drive counts as lost after kStale_s without a valid poll, or after kMissedPolls
/// missed polls in a row.
using drive::kStale_s;
inline constexpr int kMissedPolls = 3;

/// A jog ends unless it is requested again within this time.
inline constexpr double kPresence_s = 0.25;

/// Checks that the drive can be operated safely with this configuration. Returns an error for
/// values that are out of range or NaN, a speed above the drive's limit, and a keep-out distance
/// shorter than the rig's stopping distance (stopping_distance_mm). The message contains the key
/// ("rig.keep_out_mm"), its value and the requirement.
/// @return kInvalidArgument, reason "CONFIG_INVALID"
[[nodiscard]] Status check(const RigConfig& config, const drive::DriveProfile& profile);

}  // namespace hydroprint::rig
