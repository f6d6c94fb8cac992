#include "hardware/rig/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace hydroprint::rig {
namespace {

// Number of poll periods for which a jog must still have space.
constexpr double kJogLooks = 3;

/// Returns the longest accepted watchdog time; 0 for a drive without a watchdog, which is never
/// armed.
double watchdog_s(const drive::DriveProfile& profile) {
  return profile.watchdog ? profile.watchdog->largest_time_s : 0;
}

Status refuse(const std::string& axis, const char* unit, double value, Range range) {
  return limit_exceeded(
      axis,
      fmt::format("{}: {:g} {} is outside {:g} to {:g} {}; choose a value in this range", axis,
                  value, unit, range.low_mm, range.high_mm, unit),
      value, range);
}

}  // namespace

double stopping_distance_mm(const RigConfig& config, const drive::DriveProfile& profile,
                            double speed_mm_per_s) {
  const double v = std::abs(speed_mm_per_s);
  return v * kStale_s + drive::stopping_distance_mm(profile, v, watchdog_s(profile)) +
         config.slack_mm;
}

double stopping_time_s(const RigConfig& config, const drive::DriveProfile& profile) {
  return kStale_s + watchdog_s(profile) +
         config.max_speed_mm_per_s / profile.stopping_deceleration_mm_per_s2;
}

Range soft_limits(const RigConfig& config) {
  return {config.end_low_mm + config.keep_out_mm, config.end_high_mm - config.keep_out_mm};
}

tl::unexpected<Error> limit_exceeded(const std::string& axis, std::string message, double value,
                                     Range range) {
  return tl::unexpected(Error{Code::kOutOfRange,
                              std::move(message),
                              ErrorReason::LIMIT_EXCEEDED,
                              {{"axis", axis},
                               {"min", fmt::format("{:g}", range.low_mm)},
                               {"max", fmt::format("{:g}", range.high_mm)},
                               {"value", fmt::format("{:g}", value)}}});
}

Status check_target(const RigConfig& config, double target_mm) {
  const Range range = soft_limits(config);
  if (target_mm >= range.low_mm && target_mm <= range.high_mm) return {};
  return refuse("position", "mm", target_mm, range);
}

Status check_speed(const RigConfig& config, double speed_mm_per_s) {
  if (speed_mm_per_s > 0 && speed_mm_per_s <= config.max_speed_mm_per_s) return {};
  return refuse("speed", "mm/s", speed_mm_per_s, {0, config.max_speed_mm_per_s});
}

bool outside_limits(const RigConfig& config, double position_mm, double start_mm) {
  const Range range = soft_limits(config);
  const double low_mm = std::min(range.low_mm, start_mm);
  const double high_mm = std::max(range.high_mm, start_mm);
  return !(position_mm >= low_mm - config.slack_mm && position_mm <= high_mm + config.slack_mm);
}

bool may_jog(const RigConfig& config, const drive::DriveProfile& profile, double position_mm,
             double speed_mm_per_s) {
  const double v = std::abs(speed_mm_per_s);
  const double ahead_mm =
      v * kJogLooks * config.poll_period_s + drive::stopping_distance_mm(profile, v, 0);
  const Range range = soft_limits(config);
  const double room_mm =
      speed_mm_per_s > 0 ? range.high_mm - position_mm : position_mm - range.low_mm;
  return room_mm > ahead_mm;
}

double following_band_mm(const RigConfig& config, double speed_mm_per_s) {
  return config.following_error_mm + config.following_error_s * std::abs(speed_mm_per_s);
}

}  // namespace hydroprint::rig
