#include "hardware/rig/motion_supervisor.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "tests/hardware/rig/axis.h"

namespace hydroprint::rig {
namespace {

using Kind = Event::Kind;

drive::DriveState axis(double t_s, double position_mm, bool moving) {
  drive::DriveState out;
  out.time = at(t_s);
  out.position_mm = position_mm;
  out.enabled = out.homed = true;
  out.moving = moving;
  return out;
}

/// The event with which a supervisor ends a motion, its fault, and its time.
struct End {
  std::optional<Kind> event;
  Cause cause = Cause::kNone;
  double t_s = 0;
  int legs = 0;
};

/// Runs a supervisor on an axis. `where` returns its position at a time in s after the leg's start.
End play(MotionSupervisor& supervisor, const std::function<double(const Travel&, double)>& where,
         double latest_s = 60) {
  End end;
  std::optional<Travel> travel;
  double leg_s = 0, position_mm = 10;
  for (double t_s = 0; t_s < latest_s; t_s += 0.02) {
    const bool moving = travel && t_s - leg_s < travel->duration_s();
    if (travel) position_mm = where(*travel, t_s - leg_s);
    const auto advice = supervisor.look(axis(t_s, position_mm, moving));
    if (advice.event) {
      end.event = advice.event->kind;
      end.cause = advice.event->cause;
      end.t_s = t_s;
      return end;
    }
    if (!advice.next) continue;
    ++end.legs;
    leg_s = t_s;
    travel.emplace(position_mm, advice.next->target_mm, advice.next->speed_mm_per_s,
                   test_profile().acceleration_mm_per_s2);
    supervisor.begin_leg(at(t_s));
  }
  return end;
}

double on_time(const Travel& travel, double t_s) { return travel.position_mm(t_s); }

MotionSupervisor move_supervisor(double target_mm, double speed_mm_per_s) {
  return {test_config(), test_profile(), {Motion::kMove, {{target_mm, speed_mm_per_s}}}, at(0), 10};
}

TEST(MotionSupervisor, AMoveIsDoneWhenTheAxisRestsAtItsTarget) {
  MotionSupervisor supervisor = move_supervisor(30, 10);
  const End end = play(supervisor, on_time);
  EXPECT_EQ(end.event, Kind::kMotionDone);
  EXPECT_NEAR(end.t_s, Travel(10, 30, 10, 100).duration_s(), 0.05);
}

TEST(MotionSupervisor, ADipPerformsEachLegAndHold) {
  MotionSupervisor supervisor(test_config(), test_profile(),
                              {Motion::kDip, {{60, 5, 3}, {20, 10, 0}, {10, 10, 1}}}, at(0), 10);
  const End end = play(supervisor, on_time);
  EXPECT_EQ(end.event, Kind::kMotionDone);
  EXPECT_EQ(end.legs, 3);
  EXPECT_NEAR(end.t_s, 10 + 0.05 + 3 + 4 + 0.1 + 1 + 0.1 + 1, 0.2);
}

TEST(MotionSupervisor, AStalledAxisIsDetectedWithinTheBand) {
  for (const double speed : {1.0, 5.0, 10.0}) {
    MotionSupervisor supervisor = move_supervisor(200, speed);
    const End end = play(supervisor, [](const Travel& t, double s) {
      return t.position_mm(std::min(s, 1.0));  // the axis is blocked from 1 s on
    });
    EXPECT_EQ(end.cause, Cause::kFollowingError);
    const RigConfig config = test_config();
    const double band_s = config.following_error_s + config.following_error_mm / speed;
    EXPECT_NEAR(end.t_s, 1 + band_s, 0.05) << speed;
  }
}

TEST(MotionSupervisor, AnAxisThatLagsWithinTheBandContinues) {
  MotionSupervisor supervisor = move_supervisor(100, 10);
  const End end =
      play(supervisor, [](const Travel& t, double s) { return t.position_mm(s - 0.1); });
  EXPECT_EQ(end.event, Kind::kMotionDone);
}

TEST(MotionSupervisor, AFrozenOrMissingPositionIsAFollowingError) {
  MotionSupervisor frozen = move_supervisor(100, 10);
  EXPECT_EQ(play(frozen, [](const Travel&, double) { return 10.0; }).cause, Cause::kFollowingError);
  MotionSupervisor none = move_supervisor(100, 10);
  EXPECT_TRUE(play(none, [](const Travel&, double) {
                return std::numeric_limits<double>::quiet_NaN();
              }).event);
}

TEST(MotionSupervisor, AnAxisThatStopsShortIsNotDone) {
  MotionSupervisor supervisor = move_supervisor(100, 10);
  const End end = play(supervisor, [](const Travel& t, double s) {
    return std::min(t.position_mm(s), 99.8);  // within the following band, but not at the target
  });
  EXPECT_EQ(end.cause, Cause::kFollowingError);
}

TEST(MotionSupervisor, RunningPastTheSoftLimitTripsTheGuard) {
  MotionSupervisor supervisor = move_supervisor(300, 10);
  const End end =
      play(supervisor, [](const Travel& t, double s) { return t.position_mm(s) + 1.1; });
  EXPECT_EQ(end.cause, Cause::kGuard);
}

MotionSupervisor home_supervisor() {
  return {test_config(), test_profile(), {Motion::kHome}, at(0), 0};
}

drive::DriveState homing(double t_s, bool moving, bool homed, double position_mm = 0) {
  drive::DriveState out = axis(t_s, position_mm, moving);
  out.homed = homed;
  return out;
}

std::optional<Kind> kind_of(const MotionSupervisor::Advice& advice) {
  return advice.event ? std::optional(advice.event->kind) : std::nullopt;
}
Cause cause_of(const MotionSupervisor::Advice& advice) {
  return advice.event ? advice.event->cause : Cause::kNone;
}

TEST(MotionSupervisor, HomingIsDoneWhenHomedAndAtRestAfterMotion) {
  MotionSupervisor supervisor = home_supervisor();
  EXPECT_FALSE(supervisor.look(homing(0.02, false, true)).event)
      << "an earlier homing does not count";
  EXPECT_FALSE(supervisor.look(homing(0.04, true, false)).event);
  EXPECT_FALSE(supervisor.look(homing(0.06, true, true)).event);
  EXPECT_EQ(kind_of(supervisor.look(homing(0.08, false, true))), Kind::kMotionDone);
}

TEST(MotionSupervisor, AHomeThatWasNotSeenDoesNotCount) {
  MotionSupervisor stale = home_supervisor();
  EXPECT_FALSE(stale.look(homing(0.02, true, true)).event);
  EXPECT_EQ(cause_of(stale.look(homing(0.04, false, true))), Cause::kHomingFailed);
  MotionSupervisor by_switch = home_supervisor();
  drive::DriveState pressed = homing(0.02, true, true);
  pressed.home_switch = true;
  EXPECT_FALSE(by_switch.look(pressed).event);
  EXPECT_FALSE(by_switch.look(homing(0.04, true, true)).event);
  EXPECT_EQ(kind_of(by_switch.look(homing(0.06, false, true))), Kind::kMotionDone);
}

TEST(MotionSupervisor, HomingFailsAwayFromZero) {
  MotionSupervisor supervisor = home_supervisor();
  EXPECT_FALSE(supervisor.look(homing(0.02, true, false, 80)).event);
  EXPECT_EQ(cause_of(supervisor.look(homing(0.04, false, true, 80))), Cause::kHomingFailed);
}

TEST(MotionSupervisor, HomingFailsAfterAWayLongerThanTheAxis) {
  MotionSupervisor supervisor = home_supervisor();
  const RigConfig config = test_config();
  const double longest_mm = config.end_high_mm - config.end_low_mm + config.keep_out_mm;
  for (int i = 0;; ++i) {
    const double way_mm = 0.2 * i;
    const auto advice = supervisor.look(homing(0.02 * i, true, false, 100 - way_mm));
    if (way_mm <= longest_mm - 0.1) {
      ASSERT_FALSE(advice.event) << way_mm;
      continue;
    }
    if (!advice.event) continue;
    EXPECT_NEAR(way_mm, longest_mm, 0.3);
    EXPECT_EQ(cause_of(advice), Cause::kHomingFailed);
    break;
  }
}

TEST(MotionSupervisor, HomingFailsWithoutHomeOrAfterATimeout) {
  MotionSupervisor ends = home_supervisor();
  EXPECT_FALSE(ends.look(homing(0.04, true, false)).event);
  EXPECT_EQ(cause_of(ends.look(homing(0.06, false, false))), Cause::kHomingFailed);
  MotionSupervisor never_moves = home_supervisor();
  EXPECT_EQ(cause_of(never_moves.look(homing(0.6, false, false))), Cause::kHomingFailed);
  MotionSupervisor endless = home_supervisor();
  EXPECT_EQ(cause_of(endless.look(homing(test_config().home_timeout_s + 1, true, false))),
            Cause::kHomingFailed);
}

TEST(MotionSupervisor, AJogLastsAsLongAsItIsHeld) {
  MotionSupervisor supervisor(test_config(), test_profile(), {Motion::kJog, {}, 5}, at(0), 100);
  for (double t_s = 0; t_s < 3; t_s += 0.2) {
    supervisor.hold_jog(at(t_s), at(t_s), 5);
    EXPECT_FALSE(supervisor.look(axis(t_s + 0.19, 100 + 5 * t_s, true)).event);
  }
  EXPECT_EQ(kind_of(supervisor.look(axis(3.3, 116, true))), Kind::kJogOver);
}

TEST(MotionSupervisor, AnOlderHoldDoesNotShortenAJog) {
  MotionSupervisor supervisor(test_config(), test_profile(), {Motion::kJog, {}, 5}, at(1), 100);
  supervisor.hold_jog(at(0.5), at(1), 5);
  EXPECT_FALSE(supervisor.look(axis(1.2, 101, true)).event);
}

TEST(MotionSupervisor, AJogEndsBeforeTheSoftLimit) {
  MotionSupervisor supervisor(test_config(), test_profile(), {Motion::kJog, {}, 10}, at(0), 299);
  EXPECT_EQ(kind_of(supervisor.look(axis(0.01, 299.9, true))), Kind::kJogOver);
}

TEST(Plan, IsRefusedIfOneLegIsOutOfReach) {
  const RigConfig config = test_config();
  EXPECT_TRUE(check(config, {Motion::kDip, {{60, 5, 3}, {20, 10, 0}}}));
  EXPECT_FALSE(check(config, {Motion::kDip, {{60, 5, 3}, {301, 10, 0}}}));
  EXPECT_FALSE(check(config, {Motion::kDip, {{60, 5, 3}, {20, 11, 0}}}));
  EXPECT_FALSE(check(config, {Motion::kDip, {{60, 5, -1}}}));
  EXPECT_FALSE(check(config, {Motion::kDip, {}}));
  EXPECT_FALSE(check(config, {Motion::kMove, {{60, 5}, {20, 5}}}));
  EXPECT_FALSE(check(config, {Motion::kJog, {}, 0}));
  EXPECT_TRUE(check(config, {Motion::kJog, {}, -10}));
}

}  // namespace
}  // namespace hydroprint::rig
