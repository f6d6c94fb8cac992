#include "hardware/rig/motion_profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace hydroprint::rig {
namespace {

TEST(Travel, IsATrapezoidOfSpeed) {
  // 10 mm/s at 100 mm/s^2: ramps of 0.1 s and 0.5 mm at both ends, 1.9 s between them.
  const Travel travel(5, 25, 10, 100);
  EXPECT_NEAR(travel.duration_s(), 2.1, 1e-12);
  EXPECT_NEAR(travel.cruise_begin_s(), 0.1, 1e-12);
  EXPECT_NEAR(travel.cruise_end_s(), 2.0, 1e-12);
  EXPECT_NEAR(travel.speed_mm_per_s(), 10, 1e-12);
  EXPECT_NEAR(travel.position_mm(0.1), 5.5, 1e-12);
  EXPECT_NEAR(travel.position_mm(1.1), 15.5, 1e-12);
  EXPECT_NEAR(travel.position_mm(2.0), 24.5, 1e-12);
  EXPECT_EQ(travel.position_mm(-1), 5);
  EXPECT_NEAR(travel.position_mm(3), 25, 1e-12);
}

TEST(Travel, AShortMoveNeverReachesItsSpeed) {
  const Travel travel(0, 0.25, 10, 100);  // accelerates to 5 mm/s and brakes again
  EXPECT_NEAR(travel.speed_mm_per_s(), 5, 1e-12);
  EXPECT_NEAR(travel.duration_s(), 0.1, 1e-12);
  EXPECT_NEAR(travel.cruise_begin_s(), travel.cruise_end_s(), 1e-12);
  EXPECT_NEAR(travel.position_mm(0.05), 0.125, 1e-12);
}

TEST(Travel, AMoveOfZeroLengthTakesNoTime) {
  const Travel travel(7, 7, 10, 100);
  EXPECT_EQ(travel.duration_s(), 0);
  EXPECT_EQ(travel.position_mm(1), 7);
}

TEST(Travel, NeverExceedsSpeedOrAccelerationEitherWay) {
  for (const double to_mm : {30.0, -30.0, 1.0, -0.1}) {
    const double v = 8, a = 50, dt_s = 1e-3;
    const Travel travel(0, to_mm, v, a);
    double before_mm = 0, speed = 0;
    for (double t_s = dt_s; t_s < travel.duration_s() + 0.1; t_s += dt_s) {
      const double next = (travel.position_mm(t_s) - before_mm) / dt_s;
      EXPECT_LE(std::abs(next), v + 1e-9);
      EXPECT_LE(std::abs(next - speed), a * dt_s + 1e-9);
      before_mm = travel.position_mm(t_s);
      speed = next;
    }
    EXPECT_NEAR(before_mm, to_mm, 1e-12);
  }
}

}  // namespace
}  // namespace hydroprint::rig
