#include "sim/waterline/pull_index.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace hydroprint::waterline {
namespace {

using Eigen::Vector2d;

/// Pull of the nearest segment, by brute force.
Vector2d nearest_pull(const std::vector<Contour>& contours, const Vector2d& p) {
  double best = std::numeric_limits<double>::infinity();
  Vector2d pull = Vector2d::Zero();
  for (const Contour& contour : contours) {
    for (const Segment& s : contour) {
      const Vector2d along = s.b_mm - s.a_mm;
      const double t = std::clamp((p - s.a_mm).dot(along) / along.squaredNorm(), 0.0, 1.0);
      const double square = (s.a_mm + t * along - p).squaredNorm();
      if (square < best) {
        best = square;
        pull = (1 - t) * s.pull_a + t * s.pull_b;
      }
    }
  }
  return pull;
}

TEST(PullIndex, FindsTheNearestSegmentAsBruteForceDoes) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-30, 30);
  std::uniform_real_distribution<double> step(-4, 4);
  std::vector<Contour> contours(3);
  for (Contour& contour : contours) {
    for (int i = 0; i < 40; ++i) {
      const Vector2d a(place(random), place(random));
      const Vector2d b = a + Vector2d(step(random), step(random));
      contour.push_back({a, b, Vector2d(step(random), 1), Vector2d(step(random), -1)});
    }
  }
  const PullIndex index(contours);
  std::uniform_real_distribution<double> anywhere(-80, 80);
  for (int i = 0; i < 3000; ++i) {
    const Vector2d p = i % 2 == 0 ? Vector2d(anywhere(random), anywhere(random))
                                  : Vector2d(place(random), place(random));
    EXPECT_LT((index.at(p) - nearest_pull(contours, p)).norm(), 1e-12) << p.transpose();
  }
}

TEST(PullIndex, WithoutSegmentsGivesZero) {
  EXPECT_EQ(PullIndex().at({1, 2}), Vector2d(0, 0));
  EXPECT_EQ(PullIndex(std::vector<Contour>()).at({1, 2}), Vector2d(0, 0));
}

TEST(PullIndex, AcceptsSegmentsWithoutLength) {
  const PullIndex index({{{{1, 1}, {1, 1}, {3, 4}, {3, 4}}}});
  EXPECT_EQ(index.at({50, 50}), Vector2d(3, 4));
}

}  // namespace
}  // namespace hydroprint::waterline
