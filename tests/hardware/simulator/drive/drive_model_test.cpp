#include "hardware/simulator/drive/drive_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace hydroprint::simulated_drive {
namespace {

using drive::Command;

/// A machine and a drive that receives messages regularly.
struct Bench {
  Machine machine;
  Inputs inputs;
  Model model = switched_on(50);

  [[nodiscard]] bool order(Command command, double position_mm = 0, double speed = 0) {
    const auto after = execute(machine, model, inputs, {command, position_mm, speed, 0});
    if (after) model = *after;
    return after.has_value();
  }
  void run(double seconds) {
    for (; seconds > 0; seconds -= 0.01) {
      model.heard_s = model.time_s;
      model = step(machine, model, inputs, std::min(seconds, 0.01));
    }
  }
  void start(double x_mm = 50) {
    model = switched_on(x_mm);
    ASSERT_TRUE(order(Command::kEnable));
  }
};

TEST(DriveModel, HomesToTheEdgeOfTheSwitchFromEitherSide) {
  for (const double start_mm : {30.0, 0.2, -0.001, -4.0}) {
    Bench bench;
    bench.start(start_mm);
    ASSERT_TRUE(bench.order(Command::kHome));
    EXPECT_FALSE(bench.model.homed);
    bench.run(12);
    EXPECT_TRUE(bench.model.homed) << start_mm;
    EXPECT_EQ(bench.model.mode, Mode::kHold);
    EXPECT_EQ(bench.model.zero_mm, 0);
    EXPECT_NEAR(bench.model.actual.x_mm, 0, 1e-9);
  }
}

TEST(DriveModel, HomingWithoutASwitchEndsAtTheLimitSwitch) {
  Bench bench;
  bench.start(30);
  bench.inputs.negative_end = true;
  EXPECT_FALSE(bench.order(Command::kHome)) << "homing must not start into a pressed switch";
  bench.inputs.negative_end = false;
  ASSERT_TRUE(bench.order(Command::kHome));
  bench.run(0.5);
  bench.inputs.negative_end = true;
  bench.run(1);
  EXPECT_EQ(bench.model.alarm, kHomingFailed);
  EXPECT_FALSE(bench.model.homed);
  EXPECT_EQ(bench.model.mode, Mode::kOff);
}

TEST(DriveModel, SilenceStopsTheAxisWithinWatchdogTimeAndStoppingDistance) {
  Bench bench;
  bench.start();
  ASSERT_TRUE(bench.order(Command::kMove, 100, 10));
  bench.run(1);
  const double x_mm = bench.model.actual.x_mm;
  bench.model = step(bench.machine, bench.model, bench.inputs, 5);  // no messages
  EXPECT_EQ(bench.model.alarm, kWatchdog);
  EXPECT_EQ(bench.model.mode, Mode::kOff);
  // The last message arrived at most 10 ms (one time step) before x was read.
  const double most_mm = 10 * 0.25 + 10.0 * 10 / (2 * 200);
  EXPECT_LE(bench.model.actual.x_mm - x_mm, most_mm + 1e-9);
  EXPECT_GE(bench.model.actual.x_mm - x_mm, most_mm - 10 * 0.011);
}

TEST(DriveModel, WatchdogWithoutActionDoesNotStopTheAxis) {
  Bench bench;
  bench.machine.watchdog_action = WatchdogAction::kNothing;
  bench.start();
  ASSERT_TRUE(bench.order(Command::kMove, 100, 10));
  bench.model = step(bench.machine, bench.model, bench.inputs, 20);
  EXPECT_EQ(bench.model.actual.x_mm, 150);
}

TEST(DriveModel, JogEndsWhenItIsNotCommandedAgain) {
  Bench bench;
  bench.start();
  ASSERT_TRUE(bench.order(Command::kJogPositive, 0, 10));
  for (int i = 0; i < 20; ++i) {
    bench.run(0.05);
    ASSERT_TRUE(bench.order(Command::kJogPositive, 0, 10));
  }
  EXPECT_EQ(bench.model.actual.v_mm_per_s, 10);
  bench.run(0.19);
  EXPECT_EQ(bench.model.actual.v_mm_per_s, 10);
  bench.run(0.1);
  EXPECT_EQ(bench.model.actual.v_mm_per_s, 0);
  EXPECT_EQ(bench.model.mode, Mode::kHold);
}

TEST(DriveModel, LimitSwitchesStopTheAxisAndOnlyAllowMotionAwayFromThem) {
  Bench bench;
  bench.start(290);
  ASSERT_TRUE(bench.order(Command::kMove, 100, 20));
  bench.run(3);
  EXPECT_EQ(bench.model.alarm, kPositiveEnd);
  EXPECT_TRUE(at_positive_end(bench.machine, bench.model, bench.inputs));
  EXPECT_LT(bench.model.actual.x_mm, 305 + 20.0 * 20 / (2 * 200) + 0.03);
  EXPECT_FALSE(bench.order(Command::kEnable)) << "the drive must not be enabled before the reset";
  ASSERT_TRUE(bench.order(Command::kResetFault));
  ASSERT_TRUE(bench.order(Command::kEnable));
  EXPECT_EQ(bench.model.mode, Mode::kHold) << "a reset starts no motion";
  EXPECT_FALSE(bench.order(Command::kJogPositive, 0, 5));
  ASSERT_TRUE(bench.order(Command::kJogNegative, 0, 5));
  bench.run(0.1);
  EXPECT_LT(bench.model.actual.v_mm_per_s, 0);
  EXPECT_EQ(bench.model.alarm, kNoAlarm);
}

TEST(DriveModel, StopButtonBrakesAndDisables) {
  Bench bench;
  bench.start();
  ASSERT_TRUE(bench.order(Command::kMove, 100, 10));
  bench.run(1);
  const double x_mm = bench.model.actual.x_mm;
  bench.inputs.stop_button = true;
  bench.run(1);
  EXPECT_EQ(bench.model.mode, Mode::kOff);
  EXPECT_LE(bench.model.actual.x_mm - x_mm, 10.0 * 10 / (2 * 200) + 10 * 1e-3 + 1e-9);
  EXPECT_FALSE(bench.order(Command::kEnable));
  bench.inputs.stop_button = false;
  bench.run(1);
  EXPECT_EQ(bench.model.mode, Mode::kOff) << "releasing the button starts no motion";
  EXPECT_TRUE(bench.order(Command::kEnable));
}

TEST(DriveModel, StallIsAFollowingError) {
  Bench bench;
  bench.start();
  ASSERT_TRUE(bench.order(Command::kMove, 100, 10));
  bench.run(1);
  const double x_mm = bench.model.actual.x_mm;
  bench.inputs.stalled = true;
  bench.run(0.5);
  EXPECT_EQ(bench.model.alarm, kFollowingError);
  EXPECT_EQ(bench.model.actual.x_mm, x_mm);
  EXPECT_EQ(bench.model.mode, Mode::kOff);
}

TEST(DriveModel, FrozenEncoderReportsAConstantPositionWhileTheCarriageMoves) {
  Bench bench;
  bench.start();
  ASSERT_TRUE(bench.order(Command::kMove, 100, 10));
  bench.run(1);
  bench.inputs.frozen = true;
  const double told_mm = feedback(bench.model, bench.inputs).x_mm;
  bench.run(1);
  EXPECT_EQ(feedback(bench.model, bench.inputs).x_mm, told_mm);
  EXPECT_GT(bench.model.actual.x_mm, 65);
  EXPECT_EQ(bench.model.alarm, kNoAlarm);
}

TEST(DriveModel, NothingMovesUnlessEnabled) {
  Bench bench;
  for (const Command command : {Command::kHome, Command::kMove, Command::kJogPositive}) {
    EXPECT_FALSE(bench.order(command, 10, 5));
  }
  EXPECT_TRUE(bench.order(Command::kStop)) << "a stop is always accepted";
  EXPECT_TRUE(bench.order(Command::kDisable));
  bench.run(1);
  EXPECT_EQ(bench.model.actual.x_mm, 50);
}

}  // namespace
}  // namespace hydroprint::simulated_drive
