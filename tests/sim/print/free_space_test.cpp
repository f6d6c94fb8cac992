#include "sim/print/free_space.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/sim/print/polygons.h"

namespace hydroprint::print {
namespace {

using Eigen::Vector2d;

TEST(FreeSpace, FreeBoxesKeepTheirDistanceFromAnyPolygon) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> radius(15, 70), side(2, 40), at(0, 200);
  for (int round = 0; round < 40; ++round) {
    std::vector<Vector2d> star;
    for (int i = 0; i < 24; ++i) {
      const double angle = 2 * M_PI * i / 24;
      star.emplace_back(Vector2d(100, 100) +
                        radius(random) * Vector2d(std::cos(angle), std::sin(angle)));
    }
    FreeSpace space(Box{{5, 5}, {195.3, 190}});
    space.take(star, 1);
    const Vector2d size(side(random), side(random));
    const auto found = space.find(size, {at(random), at(random)});
    if (!found) continue;
    EXPECT_GE(found->low_mm.minCoeff(), 5);
    EXPECT_LE(found->high_mm.x(), 195.3);
    EXPECT_LE(found->high_mm.y(), 190);
    for (double u = 0; u <= 1; u += 0.05) {
      for (double v = 0; v <= 1; v += 0.05) {
        const Vector2d p = found->low_mm + size.cwiseProduct(Vector2d(u, v));
        EXPECT_GE(distance_to_polygon(star, p), 1) << "round " << round;
      }
    }
    space.take(*found);
    EXPECT_FALSE(space.is_free(*found));
  }
}

TEST(FreeSpace, FindsTheLastFreePlace) {
  FreeSpace space(Box{{0, 0}, {100, 100}});
  space.take(Box{{0, 0}, {100, 90}});
  space.take(Box{{20, 90}, {100, 100}});
  const auto found = space.find({20, 10}, {80, 20});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->low_mm, Vector2d(0, 90));
  EXPECT_FALSE(space.find({20.5, 10}, {0, 0}));
}

}  // namespace
}  // namespace hydroprint::print
