#include "hardware/rig/config.h"

#include <array>
#include <sstream>

#include "hardware/rig/limits.h"

namespace hydroprint::rig {
namespace {

constexpr std::array<RigConfigKey, 10> kKeys = {{
    {"end_low_mm", &RigConfig::end_low_mm, -5000, 5000},
    {"end_high_mm", &RigConfig::end_high_mm, -5000, 5000},
    {"keep_out_mm", &RigConfig::keep_out_mm, 0, 1000},
    {"max_speed_mm_per_s", &RigConfig::max_speed_mm_per_s, 0.1, 50},
    {"slack_mm", &RigConfig::slack_mm, 0.1, 100},
    {"poll_period_s", &RigConfig::poll_period_s, 0.002, 0.02},
    {"following_error_mm", &RigConfig::following_error_mm, 0.01, 10},
    {"following_error_s", &RigConfig::following_error_s, 0.02, 2},
    {"arrival_mm", &RigConfig::arrival_mm, 0.001, 1},
    {"home_timeout_s", &RigConfig::home_timeout_s, 1, 600},
}};

template <class... Parts>
tl::unexpected<Error> refuse(const Parts&... parts) {
  std::ostringstream text;
  text << "rig.";
  (text << ... << parts);
  return fail(Code::kInvalidArgument, text.str(), "CONFIG_INVALID");
}

}  // namespace

std::span<const RigConfigKey> rig_config_keys() { return kKeys; }

Status check(const RigConfig& config, const drive::DriveProfile& profile) {
  for (const RigConfigKey& key : kKeys) {
    const double value = config.*key.member;
    if (value >= key.least && value <= key.most) continue;  // false for NaN
    return refuse(key.name, " is ", value, "; it must be from ", key.least, " to ", key.most);
  }
  if (config.max_speed_mm_per_s > profile.max_speed_mm_per_s) {
    return refuse("max_speed_mm_per_s is ", config.max_speed_mm_per_s, "; it must be at most ",
                  profile.max_speed_mm_per_s, ", the limit of the drive \"", profile.name, "\"");
  }
  const double needed_mm = stopping_distance_mm(config, profile, config.max_speed_mm_per_s);
  if (!(config.keep_out_mm >= needed_mm)) {
    return refuse("keep_out_mm is ", config.keep_out_mm, "; it must be at least ", needed_mm,
                  ", the stopping distance at ", config.max_speed_mm_per_s,
                  " mm/s after a lost link; increase it, or lower max_speed_mm_per_s");
  }
  const Range range = soft_limits(config);
  if (!(range.low_mm < range.high_mm)) {
    return refuse("end_high_mm is ", config.end_high_mm, "; it must be more than ",
                  config.end_low_mm + 2 * config.keep_out_mm,
                  ": end_low_mm plus the keep-out at both ends");
  }
  return {};
}

}  // namespace hydroprint::rig
