#include "sim/waterline/air.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "sim/sample/icosphere.h"
#include "sim/waterline/waterlines.h"
#include "tests/sim/support/bodies.h"

namespace hydroprint::waterline {
namespace {

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

Waterlines dipped(const mesh::Model& model, double depth_mm = 1e9) {
  const Body body = testing::body_of(model);
  auto lines = take_waterlines(body, film::parse_outline("200x200").value(), depth_mm, {}, {}, {});
  if (!lines) {
    ADD_FAILURE() << lines.error().message;
    return {};
  }
  return *lines;
}

int holes_with_film(const Waterline& line) {
  int count = 0;
  for (std::size_t l = 0; l < line.section.size(); ++l) {
    count += line.section[l].is_hole && line.bounds_film[l] != 0;
  }
  return count;
}

/// The immersion of the last waterline with film in a hole; -1: none.
double film_up_to_mm(const Waterlines& waterlines) {
  double last_mm = -1;
  for (const Waterline& line : waterlines.lines) {
    if (holes_with_film(line) > 0) last_mm = line.immersion_mm;
  }
  return last_mm;
}

/// A square pipe bent to an upside-down U, 22 mm high. One leg begins at 0 mm, the other at 6 mm.
mesh::Model upside_down_u() {
  return testing::blocks({0, 2, 8, 10, 12, 18, 20}, {0, 2, 8, 10}, {0, 6, 14, 20, 22},
                         [](int i, int j, int k) {
                           const bool is_leg = j == 1 && (i == 1 || (i == 4 && k > 0));
                           const bool is_bend = j == 1 && k == 2 && i >= 1 && i <= 4;
                           const bool is_body = k > 0 || i < 3;
                           return is_body && (k == 3 || (!is_leg && !is_bend));
                         });
}

TEST(TrappedAir, KeepsFilmOutOfACupAtAnyTiltAndDepth) {
  for (const double wall_mm : {1.0, 4.0}) {
    for (const double tilt_deg : {0.0, 10.0, 50.0}) {
      const mesh::Model cup = testing::tilted(
          testing::cup(14, 14 + wall_mm, 40, wall_mm, false, 64), radians(tilt_deg));
      for (const double depth_mm : {25.0, 1e9}) {
        const Waterlines w = dipped(cup, depth_mm);
        EXPECT_EQ(film_up_to_mm(w), -1) << wall_mm << ' ' << tilt_deg << ' ' << depth_mm;
        ASSERT_EQ(w.traps.size(), 1U);
        EXPECT_TRUE(w.traps[0].ceiling_mm);
        // The mouth closes when the water reaches the highest point of its inner edge.
        EXPECT_NEAR(w.traps[0].immersion_mm, (28 + wall_mm) * std::sin(radians(tilt_deg)), 0.05);
      }
    }
  }
}

TEST(TrappedAir, EscapesThroughAVentAtAnyTiltAndDepth) {
  for (const double wall_mm : {1.0, 4.0}) {
    for (const double tilt_deg : {0.0, 35.0}) {
      const mesh::Model cup = testing::tilted(
          testing::cup(14, 14 + wall_mm, 40, wall_mm, false, 64, 1), radians(tilt_deg));
      for (const double depth_mm : {25.0, 1e9}) {
        const Waterlines w = dipped(cup, depth_mm);
        EXPECT_GT(film_up_to_mm(w), 20) << wall_mm << ' ' << tilt_deg << ' ' << depth_mm;
      }
    }
  }
}

TEST(TrappedAir, EscapesFromThinTubesThatAreOpenAtBothEnds) {
  for (const double tilt_deg : {0.0, 30.0, 60.0, 75.0}) {
    const double length_mm = 40;
    const mesh::Model tube =
        testing::tilted(testing::turned({{2, length_mm}, {2, 0}, {2.5, 0}, {2.5, length_mm}}, 32),
                        radians(tilt_deg));
    const Waterlines w = dipped(tube);
    EXPECT_GT(film_up_to_mm(w), 0.9 * length_mm * std::cos(radians(tilt_deg))) << tilt_deg;
    for (const Trap& trap : w.traps) EXPECT_FALSE(trap.ceiling_mm) << tilt_deg;
  }
}

TEST(TrappedAir, IsThatAboveTheHighestWayOut) {
  // A square cup, mouth down, with a window in its side from 5 to 10 mm.
  const Waterlines w = dipped(testing::blocks({-20, -16, 16, 20}, {-20, -16, 16, 20},
                                              {0, 5, 10, 26, 30}, [](int i, int j, int k) {
                                                const bool is_window = k == 1 && i == 2 && j == 1;
                                                return k == 3 || ((i != 1 || j != 1) && !is_window);
                                              }));
  EXPECT_NEAR(film_up_to_mm(w), 5, 0.01);  // beyond the window, film is no longer in a hole
  ASSERT_EQ(w.traps.size(), 2U);
  int closed = 0;
  for (const Trap& trap : w.traps) {
    if (!trap.ceiling_mm) continue;
    ++closed;
    EXPECT_NEAR(trap.immersion_mm, 10, 0.01);
    EXPECT_NEAR(*trap.ceiling_mm, 26, 0.01);
    EXPECT_NEAR(trap.air_mm3, 16 * 32 * 32, 0.002 * 16 * 32 * 32);
  }
  EXPECT_EQ(closed, 1);
}

TEST(TrappedAir, IsKnownByItsSections) {
  const Waterlines closed = dipped(testing::cup(14, 18, 40, 4, false, 64));
  ASSERT_EQ(closed.traps.size(), 1U);
  const auto is_air = [&](double x_mm, double z_mm) {
    return is_in_air(closed.traps[0], {x_mm, 0, z_mm});
  };
  EXPECT_TRUE(is_air(0, 5) && is_air(13.9, 5) && is_air(13.9, 35.95));
  EXPECT_FALSE(is_air(14.1, 5) || is_air(18.1, 5) || is_air(13.9, 36.1) || is_air(0, -0.1));
  for (const Trap& trap : dipped(testing::cup(14, 18, 40, 4, false, 64, 1)).traps) {
    EXPECT_TRUE(trap.air.empty());
    EXPECT_FALSE(is_in_air(trap, {0, 0, 5}));
  }
}

TEST(TrappedAir, LeavesABentPipeUntilItsHigherMouthIsUnderWater) {
  const Waterlines w = dipped(upside_down_u());
  EXPECT_NEAR(film_up_to_mm(w), 6, 0.01);
  double air_mm3 = 0;
  for (const Trap& trap : w.traps) air_mm3 += trap.air_mm3;
  const double expected_mm3 = 2 * 6 * 6 * 8 + 16 * 6 * 6;  // two legs from 6 mm, and the bend
  EXPECT_NEAR(air_mm3, expected_mm3, 0.005 * expected_mm3);
}

TEST(TrappedAir, IsCountedOnceWherePocketsSplit) {
  // A pocket of 30 x 30 mm with a rib that hangs from its ceiling, from 8 to 20 mm.
  const Waterlines w = dipped(testing::blocks({-20, -15, -1, 1, 15, 20}, {-20, -15, 15, 20},
                                              {0, 8, 20, 24}, [](int i, int j, int k) {
                                                const bool is_wall = i == 0 || i == 4 || j != 1;
                                                return is_wall || k == 2 || (k == 1 && i == 2);
                                              }));
  double air_mm3 = 0;
  for (const Trap& trap : w.traps) air_mm3 += trap.air_mm3;
  const double expected_mm3 = 30 * 30 * 8 + 28 * 30 * 12;
  EXPECT_NEAR(air_mm3, expected_mm3, 0.002 * expected_mm3);
  EXPECT_EQ(film_up_to_mm(w), -1);
}

TEST(TrappedAir, IsFoundUnderUnitedParts) {
  // A ring and a lid that overlap, as separate shells; without the lid, the ring is open.
  const mesh::Model ring = testing::turned({{14, 20}, {14, 0}, {18, 0}, {18, 20}}, 64);
  const mesh::Model lid = testing::moved(testing::cylinder(18, 6, 64), {0, 0, 18});
  EXPECT_EQ(film_up_to_mm(dipped(testing::together({ring, lid}))), -1);
  EXPECT_GT(film_up_to_mm(dipped(ring)), 19);
}

TEST(TrappedAir, DoesNotDependOnAHandleAboveAThinPointedRoof) {
  // A thin cone, mouth down, beside a tall post that spreads the waterlines.
  const mesh::Model cone = testing::turned({{0, 14}, {14, 0}, {15, 0}, {0, 15}}, 64);
  const mesh::Model post = testing::moved(sample::icosphere(30, 4), {45, 0, 30});
  EXPECT_EQ(film_up_to_mm(dipped(testing::together({cone, post}))), -1);
}

}  // namespace
}  // namespace hydroprint::waterline
