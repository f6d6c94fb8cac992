#pragma once

#include <span>
#include <string_view>

#include "hardware/drive/profile.h"
#include "sim/base/result.h"

namespace hydroprint::rig {

/// Configuration of a rig's axis and its limits, in addition to the drive's profile. Positions are
/// the drive's: 0 at home, positive is down. The defaults fit hydroprint-virtual-rig.
struct RigConfig {
  double end_low_mm = -5;  ///< the limit switches, or else the ends of the axis
  double end_high_mm = 305;
  double keep_out_mm = 7;  ///< minimum distance of every motion from the ends
  double max_speed_mm_per_s = 10;
  double slack_mm = 1;  ///< tolerance of the stopping distance
  double poll_period_s = 0.02;
  double following_error_mm = 0.5;  ///< largest deviation from the expected position, at rest
  double following_error_s = 0.25;  ///< additional deviation per speed
  double arrival_mm = 0.1;          ///< largest distance from the target of a finished move
  double home_timeout_s = 120;

  bool operator==(const RigConfig&) const = default;
};

/// A member of RigConfig: name and range.
struct RigConfigKey {
  std::string_view name;
  double RigConfig::*member;
  double least;
  double most;
};

/// All keys, in order.
[[nodiscard]] std::span<const RigConfigKey> rig_config_keys();

/// The drive counts as lost without a valid poll for this time, or after this many missed polls.
inline constexpr double kStale_s = 0.25;
inline constexpr int kMissedPolls = 3;

/// A jog ends if it is not requested again within this time.
inline constexpr double kPresence_s = 0.25;

/// Checks that the drive can be operated safely with this configuration. It refuses values that are
/// out of range or not numbers, and a speed above the drive's limit. It also refuses a keep-out
/// shorter than the rig's own stopping distance (stopping_distance_mm). The message has the key
/// ("rig.keep_out_mm"), its value and the requirement.
/// @return kInvalidArgument, reason "CONFIG_INVALID"
[[nodiscard]] Status check(const RigConfig& config, const drive::DriveProfile& profile);

}  // namespace hydroprint::rig
