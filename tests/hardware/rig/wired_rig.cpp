#include "tests/hardware/rig/wired_rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <thread>

namespace hydroprint::rig {
using simulated_drive::Clock;

simulated_drive::BenchOptions starting_at(double start_mm) {
  simulated_drive::BenchOptions options;
  options.start_mm = start_mm;
  return options;
}

double WiredDrive::speed_mm_per_s() { return std::abs(truth("velocity_mm_per_s")); }

double WiredDrive::rested_s() {
  if (!wait_for([&] { return speed_mm_per_s() == 0; }))
    throw std::runtime_error("the axis keeps moving");
  return truth("rested_s");
}

double seconds_since(Clock::time_point time) {
  return std::chrono::duration<double>(Clock::now() - time).count();
}

bool wait_for(const std::function<bool()>& until, double seconds) {
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  while (!until()) {
    if (Clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(3));
  }
  return true;
}

WiredRig::WiredRig(const std::string& wire, const simulated_drive::BenchOptions& options)
    : drive_(wire, options) {
  auto controller = Controller::make({}, drive_.profile(), drive_.endpoint());
  if (!controller) throw std::runtime_error(controller.error().message);
  controller_ = std::move(*controller);
}

bool WiredRig::becomes(State wanted, double seconds) const {
  return wait_for([&] { return state() == wanted; }, seconds);
}

void WiredRig::make_ready() {
  ASSERT_TRUE(becomes(State::kDisarmed));
  ASSERT_EQ(refusal(controller_->arm()), "");
  const Answer home = controller_->home().get();
  ASSERT_TRUE(home) << home.error().message;
  ASSERT_EQ(finish(*home).outcome, MotionReport::Outcome::kDone);
  ASSERT_TRUE(becomes(State::kIdle));
}

std::uint64_t WiredRig::start_move(double target_mm, double speed_mm_per_s) {
  const Answer answer = controller_->move_to(target_mm, speed_mm_per_s).get();
  EXPECT_TRUE(answer) << answer.error().message;
  EXPECT_TRUE(wait_for([&] { return drive_.speed_mm_per_s() > 0.99 * speed_mm_per_s; }));
  return answer.value_or(0);
}

MotionReport WiredRig::report(std::uint64_t motion) const {
  const auto found = controller_->motion(motion);
  EXPECT_TRUE(found);
  return found.value_or(MotionReport{});
}

MotionReport WiredRig::finish(std::uint64_t motion, double seconds) const {
  EXPECT_TRUE(wait_for([&] { return report(motion).at_rest; }, seconds));
  return report(motion);
}

std::string refusal(std::future<Answer> answer) {
  const Answer got = answer.get();
  return got ? "" : got.error().reason;
}

}  // namespace hydroprint::rig
