#pragma once

#include <functional>
#include <memory>
#include <string>

#include "hardware/rig/controller.h"
#include "tests/hardware/simulator/drive/bench_rig.h"

namespace hydroprint::rig {

/// Where the carriage stands at the start, otherwise as it should be.
[[nodiscard]] simulated_drive::BenchOptions starting_at(double start_mm);

/// A virtual drive on a real wire, "tcp" or "rtu", with a short way home. Its own client is not
/// used, and not connected.
class WiredDrive : public simulated_drive::BenchRig {
 public:
  explicit WiredDrive(const std::string& wire,
                      const simulated_drive::BenchOptions& options = starting_at(1))
      : BenchRig(wire, options) {}

  /// Where it really is, and how fast, whatever it tells.
  [[nodiscard]] double position_mm() { return truth("position_mm"); }
  [[nodiscard]] double speed_mm_per_s();
  /// Time by the drive's own clock, which does not depend on when a test gets to look.
  [[nodiscard]] double now_s() { return truth("time_s"); }
  /// Waits until it rests: since when, by that clock. Throws if it goes on.
  [[nodiscard]] double rested_s();
};

/// Waits, looking every few ms; false if `until` did not come true in time.
[[nodiscard]] bool wait_for(const std::function<bool()>& until, double seconds = 5);

/// Seconds since then.
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
  /// Arms and homes; the test fails if that fails.
  void make_ready();
  /// Starts a move and waits until it is under way at full speed; its number.
  std::uint64_t start_move(double target_mm, double speed_mm_per_s);
  [[nodiscard]] MotionReport report(std::uint64_t motion) const;
  /// Waits until a motion is over and the axis at rest.
  [[nodiscard]] MotionReport finish(std::uint64_t motion, double seconds = 30) const;

 private:
  WiredDrive drive_;
  std::unique_ptr<Controller> controller_;
};

/// Reason of a refused order; "" if it was done.
[[nodiscard]] std::string refusal(std::future<Answer> answer);

}  // namespace hydroprint::rig
