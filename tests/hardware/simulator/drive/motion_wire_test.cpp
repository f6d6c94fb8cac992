// Motion as the client sees it, over the wire.
#include <algorithm>
#include <cmath>
#include <thread>

#include "tests/hardware/simulator/drive/bench_rig.h"

namespace hydroprint::simulated_drive {
namespace {

constexpr double kCount_mm = 1e-4;  // resolution of the virtual drive's position

/// Distance after a time t from rest, with equal ramps at both ends. Written independently of the
/// drive model.
double trapezoid_mm(double distance, double speed, double ramp, double t) {
  const double ramp_s = speed / ramp;
  const double total_s = distance / speed + ramp_s;
  t = std::clamp(t, 0.0, total_s);
  if (t < ramp_s) return ramp * t * t / 2;
  if (t > total_s - ramp_s) return distance - ramp * (total_s - t) * (total_s - t) / 2;
  return speed * (t - ramp_s / 2);
}

double seconds(Clock::duration time) { return std::chrono::duration<double>(time).count(); }

class Motion : public OnBothWires {};
HP_ON_BOTH_WIRES(Motion);

TEST_P(Motion, IsATrapezoidWithinTheDurationOfAMessage) {
  BenchRig bench(GetParam());
  bench.make_ready();
  const auto before = Clock::now();
  HP_ASSERT_OK(bench.drive().move_to(8, 10));
  const auto after = Clock::now();
  const auto begin = before + (after - before) / 2;
  const double begin_error_s = seconds(after - before) / 2;
  int samples = 0;
  bench.poll_until([&](const drive::DriveState& state) {
    const double t = seconds(state.time - begin);
    const double bound_mm = 10 * (begin_error_s + state.time_error.count()) + kCount_mm;
    EXPECT_NEAR(state.position_mm, trapezoid_mm(8, 10, 200, t), bound_mm) << "at " << t << " s";
    ++samples;
    return !state.moving;
  });
  EXPECT_GE(samples, 16) << "the drive must be polled at 20 Hz or more";
  EXPECT_NEAR(bench.drive().poll()->position_mm, 8, kCount_mm);
}

TEST_P(Motion, SpeedIsConstantBetweenTheRamps) {
  BenchRig bench(GetParam());
  bench.make_ready();
  HP_ASSERT_OK(bench.drive().move_to(-3, 5));
  bench.poll_until([&](const drive::DriveState& state) {
    const double done_mm = -state.position_mm;
    if (done_mm > 0.07 && done_mm < 2.93) {
      EXPECT_EQ(state.velocity_mm_per_s, -5);
    }
    return !state.moving;
  });
}

TEST_P(Motion, HomesFromBothSidesOfTheSwitch) {
  for (const double start_mm : {3.0, -0.5}) {
    BenchRig bench(GetParam(), {.start_mm = start_mm});
    bench.make_ready();
    EXPECT_FALSE(bench.drive().poll()->homed);
    HP_ASSERT_OK(bench.drive().home());
    const auto state = bench.poll_until([](const auto& s) { return s.homed && !s.moving; });
    EXPECT_NEAR(state.position_mm, 0, kCount_mm);
    EXPECT_NEAR(bench.position_mm(), 0, 1e-9) << "home must be the edge of the switch";
  }
}

TEST_P(Motion, StopBrakesWithinItsDistanceAndKeepsTheDriveEnabled) {
  BenchRig bench(GetParam());
  bench.make_ready();
  HP_ASSERT_OK(bench.drive().move_to(50, 10));
  bench.poll_until([](const auto& state) { return state.position_mm > 2; });
  double x_mm = 0;
  const double sent_s = seconds_of([&] {
    x_mm = bench.position_mm();
    HP_ASSERT_OK(bench.drive().stop());
  });
  const auto state = bench.poll_until([](const auto& s) { return !s.moving; });
  EXPECT_TRUE(state.enabled);
  EXPECT_LE(bench.position_mm() - x_mm, 10 * (sent_s + 0.002) + 10.0 * 10 / (2 * 200));
}

TEST_P(Motion, JogContinuesWhileCommandedAndThenEndsByItself) {
  BenchRig bench(GetParam());
  bench.make_ready();
  for (int i = 0; i < 8; ++i) {
    HP_ASSERT_OK(bench.drive().jog(-10));
    std::this_thread::sleep_for(milliseconds(50));
  }
  EXPECT_EQ(bench.drive().poll()->velocity_mm_per_s, -10);
  // The drive is polled all the time, so the jog is ended by the dead-man timer, not the watchdog.
  const auto begin = Clock::now();
  const auto state = bench.poll_until([](const auto& s) { return !s.moving; });
  EXPECT_LT(seconds(Clock::now() - begin), bench.profile().jog_dead_man_s + 0.1);
  EXPECT_FALSE(state.alarm);
  EXPECT_TRUE(state.enabled);
}

TEST_P(Motion, SilenceOfTheClientStopsTheAxisWithinWatchdogTimeAndStoppingDistance) {
  BenchRig bench(GetParam());
  bench.make_ready();
  HP_ASSERT_OK(bench.drive().move_to(100, 10));
  bench.poll_until([](const auto& state) { return state.position_mm > 1; });
  const double x_mm = bench.position_mm();
  bench.drive().disconnect();
  const double watchdog_s = bench.truth().at("watchdog_s");
  std::this_thread::sleep_for(std::chrono::duration<double>(watchdog_s + 10.0 / 200 + 0.01));
  EXPECT_EQ(bench.mode(), "off");
  EXPECT_EQ(bench.truth().at("alarm_code"), kWatchdog);
  const double allowed_mm = drive::stopping_distance_mm(bench.profile(), 10, watchdog_s);
  EXPECT_LE(bench.position_mm() - x_mm, allowed_mm + 10 * 0.002);
  // After reconnecting, the alarm is reported and explained, and a reset starts no motion.
  HP_ASSERT_OK(bench.drive().connect());
  const auto state = bench.drive().poll();
  HP_ASSERT_OK(state);
  EXPECT_TRUE(state->alarm);
  EXPECT_EQ(state->alarm_text, bench.profile().alarms.at(kWatchdog).text);
  EXPECT_FALSE(state->alarm_hint.empty());
  HP_ASSERT_OK(bench.drive().reset_fault());
  const auto reset = bench.drive().poll();
  EXPECT_FALSE(reset->alarm || reset->moving || reset->enabled);
}

TEST_P(Motion, ImpossibleMotionsAreRefusedBeforeAnythingIsSent) {
  BenchRig bench(GetParam());
  bench.make_ready();
  const double requests = bench.truth().at("requests");
  for (const double speed : {0.0, -1.0, 20.1, 1e-5, std::nan("")}) {
    const Status moved = bench.drive().move_to(1, speed);
    ASSERT_FALSE(moved);
    EXPECT_EQ(moved.error().reason, ErrorReason::LIMIT_EXCEEDED);
  }
  EXPECT_FALSE(bench.drive().move_to(1e9, 5));
  EXPECT_FALSE(bench.drive().move_to(NAN, 5));
  EXPECT_FALSE(bench.drive().jog(0));
  EXPECT_EQ(bench.truth().at("requests"), requests);
  HP_ASSERT_OK(bench.drive().move_to(1, 5));
}

}  // namespace
}  // namespace hydroprint::simulated_drive
