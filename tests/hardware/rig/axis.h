#pragma once

#include "hardware/drive/profile.h"
#include "hardware/rig/config.h"
#include "hardware/rig/samples.h"

namespace hydroprint::rig {

/// A point in time, some time after the start of a test.
inline TimePoint at(double t_s) {
  return TimePoint(
      std::chrono::duration_cast<TimePoint::duration>(std::chrono::duration<double>(1000 + t_s)));
}

/// The profile used in tests, with round numbers.
inline drive::DriveProfile test_profile() {
  drive::DriveProfile profile;
  profile.name = "test drive";
  profile.max_speed_mm_per_s = 20;
  profile.acceleration_mm_per_s2 = 100;
  profile.stopping_deceleration_mm_per_s2 = 200;
  profile.velocity.emplace();
  profile.watchdog.emplace();
  profile.watchdog->largest_time_s = 0.5;
  return profile;
}

inline RigConfig test_config() {
  RigConfig config;
  config.end_low_mm = -20;
  config.end_high_mm = 320;
  config.keep_out_mm = 20;
  return config;
}

}  // namespace hydroprint::rig
