#pragma once

#include <memory>
#include <string>

#include "hardware/rig/controller.h"
#include "tests/hardware/simulator/drive/bench_rig.h"

namespace hydroprint::rig {

using simulated_drive::BenchRig;
using testing::Clock;
using testing::seconds_since;
using testing::wait_until;

/// A controller and a virtual drive, connected over "tcp" or "rtu". The client of BenchRig is not
/// connected.
class WiredRig {
 public:
  explicit WiredRig(const std::string& wire, const testing::VirtualRigOptions& options = {});

  BenchRig& drive() { return drive_; }
  Controller* operator->() { return controller_.get(); }

  [[nodiscard]] State state() const { return controller_->snapshot().condition.state; }
  [[nodiscard]] Cause cause() const { return controller_->snapshot().condition.cause; }
  [[nodiscard]] bool becomes(State state, double seconds = 5) const;
  /// Arms and homes the rig; a failure fails the test.
  void make_ready();
  /// Starts a move, waits until it has full speed, and returns its number.
  std::uint64_t start_move(double target_mm, double speed_mm_per_s);
  [[nodiscard]] MotionReport report(std::uint64_t motion) const;
  /// Waits until a motion has ended and the axis is at rest; returns its report.
  [[nodiscard]] MotionReport finish(std::uint64_t motion, double seconds = 30) const;

 private:
  BenchRig drive_;
  std::unique_ptr<Controller> controller_;
};

/// Reason of a refused order; "" if it succeeded.
[[nodiscard]] std::string refusal(std::future<Answer> answer);

}  // namespace hydroprint::rig
