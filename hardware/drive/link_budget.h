#pragma once

#include "hardware/drive/profile.h"

namespace hydroprint::drive {

/// The link to a drive counts as lost after this time without a valid poll.
inline constexpr double kStale_s = 0.25;

/// Longest period of polls.
inline constexpr double kLongestPollPeriod_s = 0.02;

/// Allowance for repeating a read, and for the transmission of the lost one: enough for a line at
/// 38400 baud or faster, at which 200 bytes take 57 ms.
inline constexpr double kRepeatAllowance_s = 0.06;

/// Returns an upper bound of the time from a valid reply to the next one if one reply in between is
/// lost: the longest poll period + response_timeout + worst_delay (only with
/// silence_after_bad_reply) + the allowance. It must be below kStale_s, the watchdog's longest time
/// and the dead-man time of jogs, so that one lost reply ends no motion.
[[nodiscard]] inline double recovery_time_s(const DriveProfile& profile) {
  std::chrono::duration<double> waited = profile.response_timeout;
  if (profile.bus.silence_after_bad_reply) waited += profile.worst_delay;
  return kLongestPollPeriod_s + waited.count() + kRepeatAllowance_s;
}

}  // namespace hydroprint::drive
