#include "hardware/rig/config.h"

#include <fmt/format.h>

#include <array>

#include "hardware/rig/limits.h"

namespace hydroprint::rig {
namespace {

constexpr std::array<RigConfigKey, 11> kKeys = {{
    {"end_low_mm", &RigConfig::end_low_mm, -5000, 5000},
    {"end_high_mm", &RigConfig::end_high_mm, -5000, 5000},
    {"keep_out_mm", &RigConfig::keep_out_mm, 0, 1000},
    {"max_speed_mm_per_s", &RigConfig::max_speed_mm_per_s, 0.1, 50},
    {"slack_mm", &RigConfig::slack_mm, 0.1, 100},
    {"poll_period_s", &RigConfig::poll_period_s, 0.002, drive::kLongestPollPeriod_s},
    {"following_error_mm", &RigConfig::following_error_mm, 0.01, 10},
    {"following_error_s", &RigConfig::following_error_s, 0.02, 2},
    {"standstill_mm", &RigConfig::standstill_mm, 0.05, 1},
    {"arrival_mm", &RigConfig::arrival_mm, 0.001, 1},
    {"home_timeout_s", &RigConfig::home_timeout_s, 1, 600},
}};

tl::unexpected<Error> refuse(const std::string& fault) {
  return fail(Code::kInvalidArgument, "rig." + fault, ErrorReason::CONFIG_INVALID);
}

}  // namespace

std::span<const RigConfigKey> rig_config_keys() { return kKeys; }

Status check(const RigConfig& config, const drive::DriveProfile& profile) {
  for (const RigConfigKey& key : kKeys) {
    const double value = config.*key.member;
    if (value >= key.least && value <= key.most) continue;  // false for NaN
    return refuse(fmt::format("{} is {:g}; it must be from {:g} to {:g}", key.name, value,
                              key.least, key.most));
  }
  if (config.max_speed_mm_per_s > profile.max_speed_mm_per_s) {
    return refuse(fmt::format(
        "max_speed_mm_per_s is {:g}; it must be at most {:g}, the limit of the drive \"{}\"",
        config.max_speed_mm_per_s, profile.max_speed_mm_per_s, profile.name));
  }
  if (profile.homing_speed_mm_per_s.value_or(0) > config.max_speed_mm_per_s) {
    return refuse(fmt::format(
        "max_speed_mm_per_s is {:g}; it must be at least {:g}, the homing speed of the drive "
        "\"{}\"; increase it, or lower the homing speed in the drive and in its profile",
        config.max_speed_mm_per_s, *profile.homing_speed_mm_per_s, profile.name));
  }
  const double needed_mm = stopping_distance_mm(config, profile, config.max_speed_mm_per_s);
  if (!(config.keep_out_mm >= needed_mm)) {
    return refuse(fmt::format(
        "keep_out_mm is {:g}; it must be at least {:g}, the stopping distance at {:g} mm/s "
        "after a lost link; increase it, or lower max_speed_mm_per_s",
        config.keep_out_mm, needed_mm, config.max_speed_mm_per_s));
  }
  const Range range = soft_limits(config);
  if (!(range.low_mm < range.high_mm)) {
    return refuse(fmt::format(
        "end_high_mm is {:g}; it must be more than {:g}: end_low_mm plus the keep-out at both ends",
        config.end_high_mm, config.end_low_mm + 2 * config.keep_out_mm));
  }
  return {};
}

}  // namespace hydroprint::rig
