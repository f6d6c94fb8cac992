#include "sim/fit/selection.h"

#include <gtest/gtest.h>

#include <random>

namespace hydroprint::fit {
namespace {

using Eigen::Vector2d;

PointResult point(const Vector2d& film_mm, const Vector2d& residual_mm = Vector2d::Zero()) {
  return {{film_mm, Eigen::Vector3d::Zero()}, film_mm, film_mm + residual_mm, {}, false};
}

TEST(Selection, FourPlacesAreEnoughAndManyPointsOnOneSpotAreNot) {
  std::vector<PointResult> points = {point({0, 0}), point({5, 0}), point({0, 5}), point({5, 5})};
  EXPECT_TRUE(check_enough(points, "measured.csv"));
  points.back().left_out = "it fell off";
  const auto three = check_enough(points, "measured.csv");
  ASSERT_FALSE(three);
  EXPECT_TRUE(three.error().message.starts_with("measured.csv: too few points: 3 of 4 can be used"))
      << three.error().message;
  EXPECT_NE(three.error().message.find("it fell off"), std::string::npos);
  EXPECT_NE(three.error().message.find("Measure at least 4"), std::string::npos);
  EXPECT_EQ(exit_status(three.error()), ExitStatus::kBadInput);
  EXPECT_FALSE(check_enough(std::vector<PointResult>(50, point({20, 10})), "measured.csv"));
}

TEST(Selection, OutliersAreBeyondFourRobustSigmas) {
  std::mt19937 random(2);
  // All errors are within 0.24 mm, and four robust standard deviations are 0.5 mm, so no point is
  // an outlier by chance.
  std::uniform_real_distribution<double> error(-0.17, 0.17);
  std::vector<PointResult> points;
  for (int i = 0; i < 300; ++i) {
    points.push_back(point({1.0 * i, 0}, {error(random), error(random)}));
  }
  points[7].after_mm += Vector2d(2, 0);
  points[20].after_mm += Vector2d(0, -30);
  points[30].after_mm += Vector2d(9, 0);
  points[30].left_out = "not used";
  EXPECT_EQ(mark_outliers(points, 0.003), 2);
  for (int i = 0; i < 300; ++i) EXPECT_EQ(points[i].is_outlier, i == 7 || i == 20) << i;
  EXPECT_EQ(mark_outliers(points, 0.003), 0) << "a second call must find no new outliers";
}

}  // namespace
}  // namespace hydroprint::fit
