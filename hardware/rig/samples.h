#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "hardware/rig/seqlock.h"
#include "hardware/rig/state.h"

namespace hydroprint::rig {

using TimePoint = std::chrono::steady_clock::time_point;

/// One clean look at the axis.
struct Sample {
  std::uint64_t number = 0;  ///< 1, 2, ... in this process
  TimePoint time;            ///< when the position was so
  double time_error_s = 0;   ///< how far off that can be
  double position_mm = 0;
  double velocity_mm_per_s = 0;  ///< as the drive says
  double expected_mm = 0;        ///< where it should be; NaN if nothing says so
  std::uint64_t motion = 0;      ///< the motion under way; 0: none
  std::int32_t leg = -1;         ///< of it, from 0; -1: none
  State state = State::kOffline;
  bool cruising = false;  ///< it should have the leg's constant speed now
};

/// The latest samples: one thread adds and never waits, any thread copies out.
class SampleRing {
 public:
  static constexpr std::size_t kSize = std::size_t{1} << 16;  // 21 minutes at 50 Hz

  SampleRing();
  /// Numbers it and keeps it. By one thread only.
  /// @return its number
  std::uint64_t add(Sample sample);
  /// Number of the newest; 0: there is none.
  [[nodiscard]] std::uint64_t newest() const { return newest_.load(std::memory_order_acquire); }
  /// Those of the numbers `first` to `last` that are still there, oldest first.
  [[nodiscard]] std::vector<Sample> copy(std::uint64_t first, std::uint64_t last) const;

 private:
  std::unique_ptr<std::array<Seqlock<Sample>, kSize>> slots_;
  std::atomic<std::uint64_t> newest_{0};
};

/// How constant a speed was. A deviation is what the samples' time errors cannot explain: whatever
/// the times were within those, the axis was off by that much at least.
struct ConstantSpeed {
  int samples = 0;
  double speed_mm_per_s = 0;      ///< slope of the line through the positions (least squares)
  double largest_way_mm = 0;      ///< farthest that a position lies from that line
  double largest_share = 0;       ///< largest |v / v_line - 1| between samples a window apart
  double way_uncertainty_mm = 0;  ///< the way in the largest time error: more can hide in it
  double window_s = 0;
};

/// Of those samples of one leg that should have its constant speed; zero with fewer than three.
/// Speeds are taken over windows of at least `window_s`, so that they show the motion and not the
/// encoder's steps.
[[nodiscard]] ConstantSpeed constant_speed(std::span<const Sample> samples, std::uint64_t motion,
                                           int leg, double window_s = 0.2);

}  // namespace hydroprint::rig
