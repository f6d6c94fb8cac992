#include "hardware/simulator/drive/motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/support/campaign.h"

namespace hydroprint::simulated_drive {
namespace {

Goal move_to(double target_mm, double speed, double gain, double braking) {
  return {Goal::Kind::kPosition, target_mm, speed, gain, braking};
}

/// Distance after a time t from rest, with equal ramps at both ends. Written independently of the
/// drive model.
double trapezoid(double distance, double speed, double ramp, double t) {
  const double top = std::min(speed, std::sqrt(distance * ramp));
  const double ramp_s = top / ramp;
  const double total_s = distance / top + ramp_s;
  if (t <= 0) return 0;
  if (t >= total_s) return distance;
  if (t < ramp_s) return ramp * t * t / 2;
  if (t > total_s - ramp_s) return distance - ramp * (total_s - t) * (total_s - t) / 2;
  return top * (t - ramp_s / 2);
}

TEST(Motion, IsATrapezoidForAnyTimeSteps) {
  std::mt19937 random(5);
  for (const double distance : {40.0, 0.3, -25.0}) {
    for (const double cut_s : {1.0, 0.1, 1e-3}) {
      const Goal goal = move_to(distance, 5, 200, 200);
      std::uniform_real_distribution<double> cut(0, cut_s);
      Kinematics now;
      double t = 0;
      while (t < 10) {
        const double dt = cut(random);
        now = advance(now, goal, dt);
        t += dt;
        EXPECT_NEAR(now.x_mm, std::copysign(trapezoid(std::abs(distance), 5, 200, t), distance),
                    1e-9);
      }
      EXPECT_EQ(now.x_mm, distance);
      EXPECT_EQ(now.v_mm_per_s, 0);
      EXPECT_TRUE(is_reached(now, goal));
    }
  }
}

TEST(Motion, SpeedIsExactlyConstantBetweenTheRamps) {
  const Goal goal = move_to(40, 5, 200, 200);
  for (double t = 0.025; t < 8; t += 0.1) {
    EXPECT_EQ(advance({}, goal, t).v_mm_per_s, 5) << t;
  }
}

TEST(Motion, NeverExceedsItsLimitsForAnySequenceOfGoals) {
  std::mt19937 random(testing::campaign_seed(9));
  std::uniform_real_distribution<double> place(-50, 50);
  Kinematics now;
  Goal goal = move_to(10, 12, 150, 300);
  for (int i = 0; i < testing::campaign_rounds(4000); ++i) {
    if (i % 37 == 0) {
      goal.kind = i % 2 == 0 ? Goal::Kind::kPosition : Goal::Kind::kVelocity;
      goal.target_mm = place(random);
      goal.speed_mm_per_s = goal.kind == Goal::Kind::kPosition ? 12 : place(random) / 5;
    }
    const Kinematics next = advance(now, goal, 0.01);
    EXPECT_LE(std::abs(next.v_mm_per_s), 12 + 1e-9);
    EXPECT_LE(std::abs(next.v_mm_per_s - now.v_mm_per_s), 300 * 0.01 + 1e-9);
    // Position is the integral of velocity. The trapezoidal rule has an error of at most
    // a dt^2 / 4.
    EXPECT_NEAR(next.x_mm - now.x_mm, 0.01 * (now.v_mm_per_s + next.v_mm_per_s) / 2,
                300 * 1e-4 / 4 + 1e-9);
    now = next;
  }
}

TEST(Motion, StopCoversTheDistanceOfItsDeceleration) {
  const Goal stop{Goal::Kind::kVelocity, 0, 0, 200, 80};
  const Kinematics end = advance({10, -8}, stop, 5);
  EXPECT_EQ(end.v_mm_per_s, 0);
  EXPECT_NEAR(end.x_mm, 10 - 8.0 * 8 / (2 * 80), 1e-12);
}

TEST(Motion, AGoalBehindIsReachedByReversing) {
  const Goal goal = move_to(0, 5, 100, 100);
  const Kinematics end = advance({1, 10}, goal, 20);
  EXPECT_EQ(end.x_mm, 0);
  EXPECT_EQ(end.v_mm_per_s, 0);
}

}  // namespace
}  // namespace hydroprint::simulated_drive
