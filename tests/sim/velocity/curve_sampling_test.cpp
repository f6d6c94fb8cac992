#include "sim/velocity/curve_sampling.h"

#include <gtest/gtest.h>

#include <random>

#include "sim/velocity/sizing.h"
#include "tests/sim/velocity/lines.h"

namespace hydroprint::velocity {
namespace {

using Eigen::Vector2d;
using testing::Curve;

void expect_follows(const Curve& curve, double spacing, double tolerance) {
  const Curve loop = sample_loop(curve, spacing, tolerance, 0.1);
  ASSERT_GE(loop.size(), 3U);
  for (std::size_t i = 0; i < loop.size(); ++i) {
    EXPECT_LE((loop[(i + 1) % loop.size()] - loop[i]).norm(), spacing * 1.001);
    EXPECT_LT(testing::distance_to(curve, loop[i]), 1e-9) << "a sampled point is not on the curve";
  }
  for (const Vector2d& p : curve) EXPECT_LT(testing::distance_to(loop, p), tolerance + 1e-9);
  EXPECT_GT(waterline::signed_area(loop) * waterline::signed_area(curve), 0);
}

TEST(SampleLoop, ChordsKeepToSpacingAndTolerance) {
  for (const double spacing : {0.5, 1.0, 3.0}) {
    for (const double tolerance : {0.01, 0.1}) {
      expect_follows(testing::bean({3, 4}, 20), spacing, tolerance);
      expect_follows(testing::circle({0, 0}, 2, 300), spacing, tolerance);
    }
  }
}

TEST(SampleLoop, KeepsCorners) {
  // A square whose corners are not at multiples of the sampling step.
  Curve square;
  for (const Vector2d& corner :
       {Vector2d(0, 0), Vector2d(10.3, 0), Vector2d(10.3, 7.7), Vector2d(0, 7.7)}) {
    square.push_back(corner);
  }
  expect_follows(square, 1, 0.01);
  std::reverse(square.begin(), square.end());
  expect_follows(square, 1, 0.01);
}

TEST(SampleLoop, KeepsCornersAmongManyUnevenPoints) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> step(0.15, 1.7);
  Curve curve;
  const std::vector<Vector2d> corners = {{0, 0}, {20, 3}, {22, 15}, {10, 9}, {1, 14}};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d to = corners[(i + 1) % corners.size()];
    const Vector2d along = (to - corners[i]).normalized();
    for (double s = 0; s < (to - corners[i]).norm() - 0.2; s += step(random)) {
      curve.push_back(corners[i] + s * along);
    }
  }
  expect_follows(curve, 1, 0.01);
}

TEST(Sizing, IsSmallAtTheWaterlineAndGrowsWithTheDistance) {
  const film::Outline film = film::parse_outline("200x160").value();
  Curve line;
  for (int i = 0; i <= 160; ++i) line.emplace_back(-50, -80 + i);
  Sizing::Options options;
  const Sizing sizing(film, {line}, options);
  EXPECT_NEAR(sizing.at({-50, 3}), options.at_waterline_mm, 0.3);
  for (const double distance : {4.0, 10.0, 17.0}) {
    const double expected = options.at_waterline_mm + options.growth * distance;
    EXPECT_NEAR(sizing.at({-50 + distance, 10}), expected, 0.05 * expected + 0.3);
  }
  EXPECT_DOUBLE_EQ(sizing.at({95, 70}), options.most_mm);
  EXPECT_DOUBLE_EQ(sizing.at({9500, 70}), options.most_mm);
}

}  // namespace
}  // namespace hydroprint::velocity
