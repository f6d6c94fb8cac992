#pragma once

#include <functional>
#include <memory>
#include <string>

#include "hardware/rig/controller.h"
#include "tests/hardware/simulator/drive/bench_rig.h"

namespace hydroprint::rig {

/// Default options, but with the carriage at this position at the start.
[[nodiscard]] simulated_drive::BenchOptions starting_at(double start_mm);

/// A virtual drive on a real wire, "tcp" or "rtu", with a short distance to home. Its own client is
/// not connected.
class WiredDrive : public simulated_drive::BenchRig {
 public:
  explicit WiredDrive(const std::string& wire,
                      const simulated_drive::BenchOptions& options = starting_at(1))
      : BenchRig(wire, options) {}

  /// True position and speed, whatever the drive reports.
  [[nodiscard]] double position_mm() { return truth("position_mm"); }
  [[nodiscard]] double speed_mm_per_s();
  /// Time by the drive's own clock, which does not depend on delays of the test.
  [[nodiscard]] double now_s() { return truth("time_s"); }
  /// Waits until the axis is at rest and returns the time of standstill by that clock. Throws if it
  /// keeps moving.
  [[nodiscard]] double rested_s();
};

/// Polls every few ms; false if `until` did not become true in time.
[[nodiscard]] bool wait_for(const std::function<bool()>& until, double seconds = 5);

/// Seconds since `time`.
[[nodiscard]] double seconds_since(simulated_drive::Clock::time_point time);

/// A controller and its drive.
class WiredRig {
 public:
  explicit WiredRig(const std::string& wire,
                    const simulated_drive::BenchOptions& options = starting_at(1));

  WiredDrive& drive() { return drive_; }
  Controller* operator->() { return controller_.get(); }

  [[nodiscard]] State state() const { return controller_->snapshot().condition.state; }
  [[nodiscard]] Cause cause() const { return controller_->snapshot().condition.cause; }
  [[nodiscard]] bool becomes(State state, double seconds = 5) const;
  /// Arms and homes the rig; a failure fails the test.
  void make_ready();
  /// Starts a move, waits until it has full speed, and returns its number.
  std::uint64_t start_move(double target_mm, double speed_mm_per_s);
  [[nodiscard]] MotionReport report(std::uint64_t motion) const;
  /// Waits until a motion has ended and the axis is at rest.
  [[nodiscard]] MotionReport finish(std::uint64_t motion, double seconds = 30) const;

 private:
  WiredDrive drive_;
  std::unique_ptr<Controller> controller_;
};

/// Reason of a refused order; "" if it succeeded.
[[nodiscard]] std::string refusal(std::future<Answer> answer);

}  // namespace hydroprint::rig
