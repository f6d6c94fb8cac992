#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "hardware/rig/seqlock.h"
#include "hardware/rig/state.h"

namespace hydroprint::rig {

using TimePoint = std::chrono::steady_clock::time_point;

/// Returns the time from one point to another, in s.
[[nodiscard]] inline double seconds(TimePoint from, TimePoint to) {
  return std::chrono::duration<double>(to - from).count();
}

/// A valid sample of the axis.
struct Sample {
  std::uint64_t number = 0;  ///< 1, 2, ... in this process
  TimePoint time;            ///< time of the position
  double time_error_s = 0;   ///< uncertainty of `time`
  double position_mm = 0;
  double velocity_mm_per_s = 0;  ///< as reported by the drive
  double expected_mm = 0;        ///< expected position; NaN if unknown
  std::uint64_t motion = 0;      ///< the motion in progress; 0: none
  std::int32_t leg = -1;         ///< leg of the motion, from 0; -1: none
  State state = State::kOffline;
  bool cruising = false;  ///< the leg's speed should be constant now
};

/// A ring buffer of the latest samples: one thread adds samples without waiting, other threads copy
/// them.
class SampleRing {
 public:
  static constexpr std::size_t kSize = std::size_t{1} << 16;  // 21 minutes at 50 Hz

  SampleRing();
  /// Stores a sample under the next number, and returns that number. Only one thread may call this.
  std::uint64_t add(Sample sample);
  /// Returns the number of the newest sample; 0: none.
  [[nodiscard]] std::uint64_t newest() const { return newest_.load(std::memory_order_acquire); }
  /// Returns a copy of the samples `first` to `last` that still exist, oldest first.
  [[nodiscard]] std::vector<Sample> copy(std::uint64_t first, std::uint64_t last) const;
  /// Returns the memory of the samples, for lock_memory().
  [[nodiscard]] std::span<const std::byte> memory() const {
    return std::as_bytes(std::span(*slots_));
  }

 private:
  std::unique_ptr<std::array<Seqlock<Sample>, kSize>> slots_;
  std::atomic<std::uint64_t> newest_{0};
};

/// Measures of how constant a speed was. Deviations that the time errors of the samples can explain
/// are not counted, so the values are lower bounds.
struct ConstantSpeed {
  int samples = 0;
  double speed_mm_per_s = 0;  ///< slope of the line through the positions (least squares)
  double largest_way_mm = 0;  ///< largest distance of a position from that line
  double largest_share = 0;   ///< largest |v / v_line - 1|, with v averaged over `window_s`
  /// Distance travelled during the largest time error of a sample; smaller deviations cannot be
  /// detected.
  double way_uncertainty_mm = 0;
  double window_s = 0;
};

/// Evaluates the samples of one leg during which its speed should be constant; returns zero speeds
/// and deviations if there are fewer than three. Speeds are averaged over at least `window_s`, so
/// that they show the motion and not the resolution of the encoder.
[[nodiscard]] ConstantSpeed constant_speed(std::span<const Sample> samples, std::uint64_t motion,
                                           int leg, double window_s = 0.2);

}  // namespace hydroprint::rig
