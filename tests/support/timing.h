#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace hydroprint::testing {

using Clock = std::chrono::steady_clock;

/// Seconds since `time`.
[[nodiscard]] inline double seconds_since(Clock::time_point time) {
  return std::chrono::duration<double>(Clock::now() - time).count();
}

/// Duration of a call in seconds.
template <class Call>
double seconds_of(const Call& call) {
  const auto start = Clock::now();
  call();
  return seconds_since(start);
}

/// Polls `until`; false if it did not become true within `seconds`.
[[nodiscard]] inline bool wait_until(const std::function<bool()>& until, double seconds = 10,
                                     double poll_every_s = 0.005) {
  const auto start = Clock::now();
  while (!until()) {
    if (seconds_since(start) > seconds) return false;
    std::this_thread::sleep_for(std::chrono::duration<double>(poll_every_s));
  }
  return true;
}

}  // namespace hydroprint::testing
