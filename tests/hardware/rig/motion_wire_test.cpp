#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "hardware/rig/limits.h"
#include "tests/hardware/rig/wired_rig.h"

namespace hydroprint::rig {
namespace {

using Outcome = MotionReport::Outcome;

class Wired : public simulated_drive::OnBothWires {};
HP_ON_BOTH_WIRES(Wired);

TEST_P(Wired, NothingMovesBeforeArmingAndOnlyHomingBeforeHoming) {
  WiredRig rig(GetParam());
  ASSERT_TRUE(rig.becomes(State::kDisarmed));
  EXPECT_EQ(refusal(rig->home()), "STATE_FORBIDS");
  EXPECT_EQ(refusal(rig->move_to(20, 5)), "STATE_FORBIDS");
  EXPECT_EQ(refusal(rig->jog(5)), "STATE_FORBIDS");
  ASSERT_EQ(refusal(rig->arm()), "");
  EXPECT_EQ(rig.state(), State::kUnhomed);
  EXPECT_EQ(refusal(rig->move_to(20, 5)), "RIG_NOT_HOMED");
  EXPECT_EQ(refusal(rig->jog(5)), "RIG_NOT_HOMED");
  EXPECT_EQ(refusal(rig->dip({{20, 5, 0}})), "RIG_NOT_HOMED");
  EXPECT_EQ(rig.drive().position_mm(), 1);
}

TEST_P(Wired, AMoveEndsAtItsTargetAndIsFullyRecorded) {
  WiredRig rig(GetParam());
  rig.make_ready();
  const MotionReport done = rig.finish(rig.start_move(12, 10));
  EXPECT_EQ(done.outcome, Outcome::kDone);
  EXPECT_NEAR(rig.drive().position_mm(), 12, 0.01);
  EXPECT_NEAR(done.end_mm, 12, 0.01);
  const auto samples = rig->samples(done.first_sample, done.last_sample);
  ASSERT_GT(samples.size(), 20 * 1.2) << "20 Hz";
  for (const Sample& sample : samples) {
    EXPECT_EQ(sample.motion, done.number);
    // the first sample was taken before the command was sent
    if (!std::isfinite(sample.expected_mm)) continue;
    EXPECT_NEAR(sample.position_mm, sample.expected_mm, following_band_mm(rig->config(), 10));
  }
}

TEST_P(Wired, ADipHasConstantSpeedHoldsAndRetracts) {
  WiredRig rig(GetParam());
  rig.make_ready();
  const Answer dip = rig->dip({{15, 5, 0.3}, {5, 10, 0}}).get();
  ASSERT_TRUE(dip) << dip.error().message;
  EXPECT_EQ(rig.state(), State::kDipping);
  const MotionReport done = rig.finish(*dip);
  EXPECT_EQ(done.outcome, Outcome::kDone);
  EXPECT_NEAR(rig.drive().position_mm(), 5, 0.01);
  const auto samples = rig->samples(done.first_sample, done.last_sample);
  const ConstantSpeed down = constant_speed(samples, *dip, 0);
  EXPECT_GT(down.samples, 20 * 2.8) << "20 Hz";
  EXPECT_NEAR(down.speed_mm_per_s, 5, 0.05);
  EXPECT_LT(down.largest_way_mm, 0.2);
  const ConstantSpeed up = constant_speed(samples, *dip, 1);
  EXPECT_NEAR(up.speed_mm_per_s, -10, 0.1);
  std::cout << "largest deviation " << down.largest_way_mm << " mm, " << 100 * down.largest_share
            << " % of the speed\n";
}

TEST_P(Wired, ASecondCommandIsRefusedAndTheFirstContinues) {
  WiredRig rig(GetParam());
  rig.make_ready();
  const std::uint64_t first = rig.start_move(12, 10);
  EXPECT_EQ(refusal(rig->move_to(5, 5)), "MOTION_IN_PROGRESS");
  EXPECT_EQ(refusal(rig->home()), "MOTION_IN_PROGRESS");
  EXPECT_EQ(refusal(rig->jog(5)), "MOTION_IN_PROGRESS");
  EXPECT_EQ(refusal(rig->dip({{5, 5, 0}})), "MOTION_IN_PROGRESS");
  EXPECT_EQ(refusal(rig->disarm()), "MOTION_IN_PROGRESS");
  EXPECT_EQ(refusal(rig->reset()), "MOTION_IN_PROGRESS");
  EXPECT_EQ(rig.finish(first).outcome, Outcome::kDone);
  EXPECT_NEAR(rig.drive().position_mm(), 12, 0.01);
}

TEST_P(Wired, TargetsOutOfReachAreRefusedBeforeAnyMotion) {
  WiredRig rig(GetParam());
  rig.make_ready();
  const double at_mm = rig.drive().position_mm();
  EXPECT_EQ(refusal(rig->move_to(299, 5)), "LIMIT_EXCEEDED");
  EXPECT_EQ(refusal(rig->move_to(20, 10.5)), "LIMIT_EXCEEDED");
  EXPECT_EQ(refusal(rig->move_to(20, 0)), "LIMIT_EXCEEDED");
  EXPECT_EQ(refusal(rig->move_to(std::nan(""), 5)), "LIMIT_EXCEEDED");
  EXPECT_EQ(refusal(rig->dip({{20, 5, 0}, {299, 5, 0}})), "LIMIT_EXCEEDED");
  EXPECT_EQ(refusal(rig->jog(-5)), "LIMIT_EXCEEDED")
      << "the axis is at home, which lies outside the soft limits";
  EXPECT_EQ(rig.state(), State::kIdle);
  EXPECT_EQ(rig.drive().position_mm(), at_mm);
}

TEST_P(Wired, AJogContinuesWhileHeldAndStopsWithin500MsAfterwards) {
  WiredRig rig(GetParam());
  rig.make_ready();
  const auto begun = Clock::now();
  std::uint64_t motion = 0;
  double last_s = 0;
  while (seconds_since(begun) < 1) {
    last_s = rig.drive().now_s();
    const Answer answer = rig->jog(10).get();
    ASSERT_TRUE(answer) << answer.error().message;
    motion = *answer;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  EXPECT_GT(rig.drive().speed_mm_per_s(), 9.9);
  EXPECT_LT(rig.drive().rested_s() - last_s, 0.5);
  EXPECT_EQ(rig.finish(motion).outcome, Outcome::kStopped);
  EXPECT_TRUE(rig.becomes(State::kIdle));
}

TEST_P(Wired, AHeldJogStopsBeforeTheSoftLimit) {
  WiredRig rig(GetParam());
  rig.make_ready();
  ASSERT_EQ(rig.finish(rig.start_move(8, 10)).outcome, Outcome::kDone);
  while (refusal(rig->jog(-10)).empty()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  ASSERT_TRUE(rig.becomes(State::kIdle));
  const Range range = soft_limits(rig->config());
  EXPECT_GE(rig.drive().position_mm(), range.low_mm);
  EXPECT_LT(rig.drive().position_mm(), range.low_mm + 2);
}

TEST_P(Wired, AStopIsAcceptedInEveryStateAndStopsTheAxis) {
  WiredRig rig(GetParam());
  rig->stop();
  ASSERT_TRUE(rig.becomes(State::kDisarmed));
  rig->stop();
  rig.make_ready();
  rig->stop();
  const std::uint64_t motion = rig.start_move(100, 10);
  const auto asked = Clock::now();
  const double asked_s = rig.drive().now_s();
  rig->stop();
  rig->stop();
  EXPECT_LT(seconds_since(asked), 0.05) << "stop() must return at once";
  const double rest_s = rig.drive().rested_s() - asked_s;
  EXPECT_LT(rest_s, 0.25) << "braking from 10 mm/s at 200 mm/s^2 takes 0.05 s";
  EXPECT_EQ(rig.finish(motion).outcome, Outcome::kStopped);
  EXPECT_TRUE(rig.becomes(State::kIdle)) << "the axis must still be homed";
  std::cout << "at rest after " << rest_s << " s\n";
}

TEST_P(Wired, AMoveOrderedBeforeAStopDoesNotStartAfterIt) {
  WiredRig rig(GetParam());
  rig.make_ready();
  for (int i = 0; i < 12; ++i) {
    auto answer = rig->move_to(i % 2 == 0 ? 100 : 50, 10);
    rig->stop();
    (void)answer.get();
    ASSERT_TRUE(rig.becomes(State::kIdle));
    const std::uint64_t looks = rig->snapshot().jitter.ticks + 2;
    ASSERT_TRUE(wait_until([&] { return rig->snapshot().jitter.ticks > looks; }));
    EXPECT_EQ(rig.state(), State::kIdle);
    EXPECT_EQ(rig.drive().mode(), "hold");
  }
}

TEST_P(Wired, DestroyingTheControllerInMotionLeavesTheDriveAtRestWithoutTorque) {
  BenchRig drive(GetParam());
  auto controller = Controller::make({}, drive.profile(), drive.endpoint());
  ASSERT_TRUE(controller);
  ASSERT_TRUE(
      wait_until([&] { return (*controller)->snapshot().condition.state == State::kDisarmed; }));
  ASSERT_EQ(refusal((*controller)->arm()), "");
  ASSERT_EQ(refusal((*controller)->home()), "");
  ASSERT_TRUE(wait_until([&] { return drive.speed_mm_per_s() > 0; }));
  controller->reset();
  EXPECT_EQ(drive.speed_mm_per_s(), 0);
  EXPECT_TRUE(wait_until([&] { return drive.mode() == "off"; }));
}

}  // namespace
}  // namespace hydroprint::rig
