// Tests of each row of the fault table in hardware/rig/README.md, over the wire.
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "hardware/rig/limits.h"
#include "tests/hardware/rig/wired_rig.h"

namespace hydroprint::rig {
namespace {

using Outcome = MotionReport::Outcome;

class Fault : public simulated_drive::OnBothWires {};
HP_ON_BOTH_WIRES(Fault);

/// Expects that, after a fault, nothing moves until reset, arming and homing, in this order.
void expect_the_long_way_back(WiredRig& rig) {
  ASSERT_TRUE(rig.becomes(State::kFault));
  EXPECT_EQ(refusal(rig->move_to(20, 5)), "RIG_FAULTED");
  EXPECT_EQ(refusal(rig->home()), "RIG_FAULTED");
  EXPECT_EQ(refusal(rig->arm()), "RIG_FAULTED");
  const double at_mm = rig.drive().position_mm();
  ASSERT_EQ(refusal(rig->reset()), "");
  EXPECT_EQ(rig.state(), State::kDisarmed);
  EXPECT_EQ(refusal(rig->move_to(20, 5)), "STATE_FORBIDS");
  ASSERT_EQ(refusal(rig->arm()), "");
  EXPECT_EQ(refusal(rig->move_to(20, 5)), "RIG_NOT_HOMED");
  EXPECT_EQ(rig.drive().position_mm(), at_mm) << "a reset starts no motion";
  const Answer home = rig->home().get();
  ASSERT_TRUE(home);
  EXPECT_EQ(rig.finish(*home).outcome, Outcome::kDone);
  EXPECT_TRUE(rig.becomes(State::kIdle));
}

TEST_P(Fault, ALostLinkStopsTheAxisWithinItsStoppingDistance) {
  WiredRig rig(GetParam());
  rig.make_ready();
  const std::uint64_t motion = rig.start_move(100, 10);
  const double lost_mm = rig.drive().position_mm();
  rig.drive().act("unplug");
  ASSERT_TRUE(wait_until([&] { return rig.drive().speed_mm_per_s() == 0; }, 2));
  EXPECT_LE(rig.drive().position_mm() - lost_mm,
            stopping_distance_mm(rig->config(), rig->profile(), 10));
  ASSERT_TRUE(rig.becomes(State::kOffline));
  EXPECT_EQ(rig.report(motion).outcome, Outcome::kFailed);
  EXPECT_EQ(rig.report(motion).cause, Cause::kLinkLost);
  EXPECT_EQ(refusal(rig->move_to(20, 5)), "RIG_OFFLINE");
  const std::uint64_t ticks = rig->snapshot().jitter.ticks;
  EXPECT_TRUE(wait_until([&] { return rig->snapshot().jitter.ticks > ticks + 10; }))
      << "the controller must keep polling";
  rig.drive().act("replug");
  expect_the_long_way_back(rig);
}

TEST_P(Fault, ASilentDriveInMotionIsAFaultOnceItRespondsAgain) {
  WiredRig rig(GetParam());
  rig.make_ready();
  const std::uint64_t motion = rig.start_move(100, 10);
  const double begun_s = rig.drive().now_s();
  rig.drive().act("silent");
  ASSERT_TRUE(wait_until([&] { return !in_motion(rig.state()); }));
  EXPECT_LT(rig.drive().now_s() - begun_s, 1);
  EXPECT_LT(rig.drive().rested_s() - begun_s, stopping_time_s(rig->config(), rig->profile()));
  rig.drive().act("clear");
  EXPECT_EQ(rig.finish(motion).cause, Cause::kLinkLost);
  expect_the_long_way_back(rig);
}

TEST_P(Fault, OneInvalidReplyDoesNotEndADip) {
  WiredRig rig(GetParam());
  rig.make_ready();
  const Answer dip = rig->dip({{12, 10, 0}}).get();
  ASSERT_TRUE(dip);
  ASSERT_TRUE(wait_until([&] { return rig.drive().speed_mm_per_s() > 9.9; }));
  rig.drive().act("fault busy 1");
  ASSERT_TRUE(wait_until([&] { return rig->snapshot().missed_polls > 0; }));
  EXPECT_EQ(rig.finish(*dip).outcome, Outcome::kDone);
}

TEST_P(Fault, ThreeInvalidRepliesStopTheAxis) {
  WiredRig rig(GetParam());
  rig.make_ready();
  const std::uint64_t motion = rig.start_move(100, 10);
  rig.drive().act("fault busy all");
  ASSERT_TRUE(wait_until([&] { return rig.drive().speed_mm_per_s() == 0; }, 2));
  EXPECT_EQ(rig.report(motion).cause, Cause::kLinkLost);
  rig.drive().act("clear");
  expect_the_long_way_back(rig);
}

TEST_P(Fault, AStopWorksWhileRepliesHang) {
  WiredRig rig(GetParam());
  rig.make_ready();
  (void)rig.start_move(100, 10);
  rig.drive().act("fault drop all");  // the drive executes requests but does not reply
  std::this_thread::sleep_for(std::chrono::milliseconds(40));
  const auto asked = Clock::now();
  const double asked_s = rig.drive().now_s();
  rig->stop();
  EXPECT_LT(seconds_since(asked), 0.05);
  // Over RTU, the stop may have to wait for the response timeout of another request. Braking takes
  // 0.05 s more.
  EXPECT_LT(rig.drive().rested_s() - asked_s, 0.25);
}

TEST_P(Fault, APowerCycleAtRestRequiresResetArmingAndHoming) {
  WiredRig rig(GetParam());
  rig.make_ready();
  rig.drive().act("reboot 300ms");
  ASSERT_TRUE(wait_until([&] { return rig.state() != State::kIdle; }));
  expect_the_long_way_back(rig);
}

TEST_P(Fault, APowerCycleInMotionStopsTheAxisForGood) {
  WiredRig rig(GetParam());
  rig.make_ready();
  const std::uint64_t motion = rig.start_move(100, 10);
  rig.drive().act("reboot 100ms");
  ASSERT_TRUE(wait_until([&] { return rig.drive().speed_mm_per_s() == 0; }, 2));
  const double rest_mm = rig.drive().position_mm();
  EXPECT_EQ(rig.finish(motion).outcome, Outcome::kFailed);
  ASSERT_TRUE(rig.becomes(State::kFault));
  EXPECT_EQ(rig.drive().position_mm(), rest_mm);
  expect_the_long_way_back(rig);
}

TEST_P(Fault, TheStopButtonLatchesUntilReleasedResetArmedAndHomed) {
  WiredRig rig(GetParam());
  rig.make_ready();
  const std::uint64_t motion = rig.start_move(100, 10);
  rig.drive().act("press stop");
  ASSERT_TRUE(rig.becomes(State::kEstopped, 1));
  EXPECT_EQ(rig.finish(motion).cause, Cause::kStopButton);
  EXPECT_EQ(refusal(rig->reset()), "STATE_FORBIDS") << "the button is still pressed";
  EXPECT_EQ(refusal(rig->arm()), "STATE_FORBIDS");
  EXPECT_EQ(refusal(rig->move_to(20, 5)), "STATE_FORBIDS");
  const double rest_mm = rig.drive().position_mm();
  rig.drive().act("release stop");
  ASSERT_TRUE(wait_until([&] { return !rig->snapshot().bits.button; }));
  EXPECT_EQ(rig.state(), State::kEstopped) << "releasing the button does not reset the rig";
  ASSERT_EQ(refusal(rig->reset()), "");
  EXPECT_EQ(rig.state(), State::kDisarmed);
  ASSERT_EQ(refusal(rig->arm()), "");
  EXPECT_EQ(refusal(rig->move_to(20, 5)), "RIG_NOT_HOMED");
  EXPECT_EQ(rig.drive().position_mm(), rest_mm);
  ASSERT_EQ(refusal(rig->home()), "");
  EXPECT_TRUE(rig.becomes(State::kIdle, 30));
}

TEST_P(Fault, ALimitSwitchStopsTheAxis) {
  WiredRig rig(GetParam());
  rig.make_ready();
  const std::uint64_t motion = rig.start_move(100, 10);
  rig.drive().act("press positive-end");
  ASSERT_TRUE(wait_until([&] { return rig.drive().speed_mm_per_s() == 0; }, 2));
  EXPECT_EQ(rig.finish(motion).cause, Cause::kLimit);
  rig.drive().act("release positive-end");
  expect_the_long_way_back(rig);
}

TEST_P(Fault, AStalledAxisIsStopped) {
  WiredRig rig(GetParam());
  rig.make_ready();
  const std::uint64_t motion = rig.start_move(100, 10);
  rig.drive().act("press stall");
  ASSERT_TRUE(wait_until([&] { return !in_motion(rig.state()); }, 2));
  rig.drive().act("release stall");
  const MotionReport report = rig.finish(motion);
  EXPECT_EQ(report.outcome, Outcome::kFailed);
  EXPECT_TRUE(report.cause == Cause::kAlarm || report.cause == Cause::kFollowingError);
  expect_the_long_way_back(rig);
}

TEST_P(Fault, AFrozenPositionIsAFollowingError) {
  WiredRig rig(GetParam());
  rig.make_ready();
  const std::uint64_t motion = rig.start_move(100, 10);
  rig.drive().act("press freeze");
  const double frozen_mm = rig.drive().position_mm();
  ASSERT_TRUE(wait_until([&] { return !in_motion(rig.state()); }, 2));
  ASSERT_TRUE(wait_until([&] { return rig.drive().speed_mm_per_s() == 0; }, 2));
  const double band_mm = following_band_mm(rig->config(), 10);
  EXPECT_LE(rig.drive().position_mm() - frozen_mm, band_mm + 1.5);
  rig.drive().act("release freeze");
  EXPECT_EQ(rig.finish(motion).cause, Cause::kFollowingError);
  expect_the_long_way_back(rig);
}

TEST_P(Fault, ADriveThatFallsSilentAtACommandIsALostLink) {
  WiredRig rig(GetParam());
  rig.make_ready();
  rig.drive().act("silent writes");
  EXPECT_EQ(refusal(rig->move_to(20, 10)), "RIG_OFFLINE");
  EXPECT_TRUE(rig.becomes(State::kOffline));
  EXPECT_EQ(rig.cause(), Cause::kLinkLost);
  rig.drive().act("clear");
  expect_the_long_way_back(rig);
}

/// Expects STOP_NOT_OBEYED, and the drive's watchdog to bring the axis to rest.
void expect_that_the_watchdog_stops(WiredRig& rig) {
  ASSERT_TRUE(wait_until([&] { return rig.cause() == Cause::kStopNotObeyed; }, 2));
  ASSERT_TRUE(wait_until([&] { return rig.drive().speed_mm_per_s() == 0; }, 2));
  rig.drive().act("clear");
  ASSERT_TRUE(rig.becomes(State::kFault));
  EXPECT_EQ(rig.cause(), Cause::kStopNotObeyed);
}

TEST_P(Fault, AMotionBeginsThoughTheReplyToItsCommandIsLost) {
  WiredRig rig(GetParam());
  rig.make_ready();
  double target_mm = 4;
  for (const auto* fault : {"fault drop 1 writes", "fault wrong-crc 1 writes"}) {
    rig.drive().act(fault);
    const Answer answer = rig->move_to(target_mm, 10).get();
    ASSERT_TRUE(answer) << answer.error().message;
    EXPECT_EQ(rig.finish(*answer).outcome, Outcome::kDone);
    EXPECT_NEAR(rig.drive().position_mm(), target_mm, 0.01);
    target_mm += 2;
  }
}

TEST_P(Fault, AStopThatIsNotObeyedIsNamedAndLeftToTheWatchdog) {
  WiredRig rig(GetParam());
  rig.make_ready();
  const std::uint64_t motion = rig.start_move(200, 10);
  rig.drive().act("press deaf");
  const double asked_mm = rig.drive().position_mm();
  rig->stop();
  ASSERT_TRUE(wait_until([&] { return rig.cause() == Cause::kStopNotObeyed; }, 2));
  for (int i = 0; i < 10 && rig.drive().speed_mm_per_s() != 0; ++i) {
    rig->stop();  // people press it again; this must not keep the watchdog from acting
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  expect_that_the_watchdog_stops(rig);
  EXPECT_EQ(rig.report(motion).outcome, Outcome::kStopped);
  EXPECT_LE(rig.drive().position_mm() - asked_mm,
            stopping_distance_mm(rig->config(), rig->profile(), 10));
  expect_the_long_way_back(rig);
}

TEST_P(Fault, AnAxisThatRunsAwayAtRestIsStoppedByTheWatchdog) {
  WiredRig rig(GetParam());
  rig.make_ready();
  rig.drive().act("press runaway");
  ASSERT_TRUE(wait_until([&] { return rig.cause() != Cause::kNone; }, 1));
  EXPECT_EQ(rig.cause(), Cause::kUnexpectedMotion);
  expect_that_the_watchdog_stops(rig);
}

TEST_P(Fault, AnAxisThatDriftsAtRestIsStopped) {
  WiredRig rig(GetParam());
  rig.make_ready();
  const double from_mm = rig.drive().position_mm();
  rig.drive().act("press drift");
  ASSERT_TRUE(wait_until([&] { return rig.cause() != Cause::kNone; }, 10));
  EXPECT_EQ(rig.cause(), Cause::kUnexpectedMotion);
  EXPECT_LE(rig.drive().position_mm() - from_mm, 1);
}

TEST_P(Fault, ALateReplyIsNeverTakenForAnotherOne) {
  WiredRig rig(GetParam());
  rig.make_ready();
  for (int i = 0; i < 3; ++i) {
    const std::uint64_t unanswered = rig->snapshot().link.unanswered_requests;
    rig.drive().act("fault late 200ms 1");
    ASSERT_TRUE(wait_until([&] { return rig->snapshot().link.unanswered_requests > unanswered; }));
    // Waits until the late reply has arrived.
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
  }
  // The axis was at rest all the time, so no sample may show another position.
  const auto samples = rig->samples(rig.report(rig->snapshot().motion).last_sample + 1, UINT64_MAX);
  ASSERT_FALSE(samples.empty());
  for (const Sample& sample : samples) EXPECT_NEAR(sample.position_mm, 0, 0.01);
  EXPECT_NE(rig.state(), State::kMoving);
}

TEST_P(Fault, AnUnexpectedDriveIsNeitherArmedNorCommanded) {
  BenchRig drive(GetParam(), {.start_mm = 1});
  drive::DriveProfile other = drive.profile();
  other.identity.back().value = static_cast<std::uint16_t>(other.identity.back().value + 0x0100);
  const auto controller = Controller::make({}, other, drive.endpoint());
  ASSERT_TRUE(controller);
  ASSERT_TRUE(wait_until([&] { return (*controller)->trouble().has_value(); }));
  EXPECT_EQ((*controller)->trouble()->reason, ErrorReason::DRIVE_CONFIG_UNSAFE);
  EXPECT_EQ((*controller)->snapshot().condition.state, State::kOffline);
  EXPECT_EQ(refusal((*controller)->arm()), "DRIVE_CONFIG_UNSAFE");
  EXPECT_EQ(drive.mode(), "off");
}

TEST_P(Fault, AWatchdogThatIsOffTooSlowOrDoesNotStopPreventsArming) {
  using Arguments = std::vector<std::string>;
  for (const Arguments& unsafe :
       {Arguments{"--watchdog-s", "0"}, {"--watchdog-s", "5"}, {"--watchdog-action", "0"}}) {
    WiredRig rig(GetParam(), {.arguments = unsafe});
    ASSERT_TRUE(rig.becomes(State::kDisarmed));
    EXPECT_EQ(refusal(rig->arm()), "DRIVE_CONFIG_UNSAFE");
    EXPECT_EQ(rig->trouble().value_or(Error{}).reason, ErrorReason::DRIVE_CONFIG_UNSAFE);
    EXPECT_EQ(rig.drive().mode(), "off");
  }
}

TEST(FaultOfOne, AnAbsentDriveIsFoundLater) {
  BenchRig drive("tcp", {.start_mm = 1});
  drive.act("unplug");
  const auto controller = Controller::make({}, drive.profile(), drive.endpoint());
  ASSERT_TRUE(controller) << "the controller must run without a drive";
  ASSERT_TRUE(wait_until([&] { return (*controller)->trouble().has_value(); }));
  const auto asked = Clock::now();
  EXPECT_EQ(refusal((*controller)->arm()), "RIG_OFFLINE");
  EXPECT_LT(seconds_since(asked), 1);
  drive.act("replug");
  EXPECT_TRUE(
      wait_until([&] { return (*controller)->snapshot().condition.state == State::kDisarmed; }));
  EXPECT_FALSE((*controller)->trouble());
}

TEST(FaultOfOne, MotionCommandedByAnotherProgramIsStopped) {
  WiredRig rig("tcp");
  rig.make_ready();
  drive::Drive& intruder = rig.drive().drive();
  ASSERT_TRUE(intruder.connect());
  ASSERT_TRUE(intruder.poll());
  ASSERT_TRUE(intruder.move_to(50, 5));
  ASSERT_TRUE(rig.becomes(State::kFault));
  EXPECT_EQ(rig.cause(), Cause::kUnexpectedMotion);
  EXPECT_LT(rig.drive().position_mm(), 5);
}

}  // namespace
}  // namespace hydroprint::rig
