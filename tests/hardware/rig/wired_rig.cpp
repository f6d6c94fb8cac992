#include "tests/hardware/rig/wired_rig.h"

#include <gtest/gtest.h>

#include "tests/support/value_of.h"

namespace hydroprint::rig {

WiredRig::WiredRig(const std::string& wire, const testing::VirtualRigOptions& options)
    : drive_(wire, options) {
  controller_ = testing::value_of(Controller::make({}, drive_.profile(), drive_.endpoint()));
}

bool WiredRig::becomes(State wanted, double seconds) const {
  return wait_until([&] { return state() == wanted; }, seconds);
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
  EXPECT_TRUE(wait_until([&] { return drive_.speed_mm_per_s() > 0.99 * speed_mm_per_s; }));
  return answer.value_or(0);
}

MotionReport WiredRig::report(std::uint64_t motion) const {
  const auto found = controller_->motion(motion);
  EXPECT_TRUE(found);
  return found.value_or(MotionReport{});
}

MotionReport WiredRig::finish(std::uint64_t motion, double seconds) const {
  EXPECT_TRUE(wait_until([&] { return report(motion).at_rest; }, seconds));
  return report(motion);
}

std::string refusal(std::future<Answer> answer) {
  const Answer got = answer.get();
  return std::string(got ? "" : name_of(got.error().reason));
}

}  // namespace hydroprint::rig
