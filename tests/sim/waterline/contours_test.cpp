#include "sim/waterline/contours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "sim/waterline/cross_section.h"

namespace hydroprint::waterline {
namespace {

using Eigen::Vector2d;

double area_of(const Contour& contour) {
  std::vector<Vector2d> points;
  for (const Segment& s : contour) points.push_back(s.a_mm);
  return signed_area(points);
}

bool is_closed(const Contour& contour) {
  for (std::size_t i = 0; i < contour.size(); ++i) {
    if ((contour[i].b_mm - contour[(i + 1) % contour.size()].a_mm).norm() > 1e-9) return false;
  }
  return !contour.empty();
}

/// The chords of a circle that is cut at `points` places. Their pull points inwards.
std::vector<CutSegment> circle(double radius, int points) {
  std::vector<CutSegment> cuts;
  const auto at = [&](int i) -> Vector2d {
    const double angle = 2 * std::numbers::pi * (i % points) / points;
    return radius * Vector2d(std::cos(angle), std::sin(angle));
  };
  for (int i = 0; i < points; ++i) {
    const auto edge = static_cast<std::uint64_t>(i);
    cuts.push_back({{at(i), at(i + 1), -at(i).normalized(), -at(i + 1).normalized()},
                    edge,
                    (edge + 1) % static_cast<std::uint64_t>(points)});
  }
  return cuts;
}

/// Gives all ends mesh edges of their own, as in a mesh whose triangles share no corners.
std::vector<CutSegment> loose(std::vector<CutSegment> cuts) {
  std::uint64_t edge = 1000000;
  for (CutSegment& cut : cuts) {
    cut.edge_a = edge++;
    cut.edge_b = edge++;
  }
  return cuts;
}

void turn(CutSegment& cut) {
  std::swap(cut.segment.a_mm, cut.segment.b_mm);
  std::swap(cut.segment.pull_a, cut.segment.pull_b);
  std::swap(cut.edge_a, cut.edge_b);
  cut.segment.pull_a *= -1;  // the reciprocal of 1 is 1
  cut.segment.pull_b *= -1;
}

void expect_circle(const std::vector<Contour>& contours, double radius, double tolerance_mm2) {
  ASSERT_EQ(contours.size(), 1U);
  EXPECT_TRUE(is_closed(contours[0]));
  EXPECT_NEAR(area_of(contours[0]), std::numbers::pi * radius * radius, tolerance_mm2);
  for (const Segment& s : contours[0]) EXPECT_LT(s.pull_a.dot(s.a_mm), 0) << "points outwards";
}

TEST(Join, FollowsMeshEdgesInAnyOrder) {
  std::vector<CutSegment> cuts = circle(20, 500);
  std::shuffle(cuts.begin(), cuts.end(), std::mt19937(1));
  expect_circle(join(cuts), 20, 0.1);
}

TEST(Join, EqualEndsMeetWithoutACommonMeshEdge) {
  std::vector<CutSegment> cuts = loose(circle(20, 500));
  std::shuffle(cuts.begin(), cuts.end(), std::mt19937(2));
  const auto contours = join(cuts);
  expect_circle(contours, 20, 0.1);
  EXPECT_EQ(contours[0].size(), 500U);
}

TEST(Join, EndsThatRoundingSeparatesMeet) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> error(-1e-4, 1e-4);
  std::vector<CutSegment> cuts = loose(circle(20, 500));
  for (CutSegment& cut : cuts) {
    cut.segment.a_mm += Vector2d(error(random), error(random));
    cut.segment.b_mm += Vector2d(error(random), error(random));
  }
  std::shuffle(cuts.begin(), cuts.end(), random);
  expect_circle(join(cuts), 20, 0.1);
}

TEST(Join, LooseSegmentsThatRunBackwardsAreTurnedWithTheirPull) {
  std::vector<CutSegment> cuts = loose(circle(20, 500));
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    if (i % 7 == 0 || i % 11 == 3) turn(cuts[i]);
  }
  std::shuffle(cuts.begin(), cuts.end(), std::mt19937(4));
  expect_circle(join(cuts), 20, 0.1);
}

TEST(Join, GapsAreClosedByStraightLines) {
  std::vector<CutSegment> cuts = circle(20, 500);  // 0.25 mm each
  std::mt19937 random(5);
  std::erase_if(cuts, [&](const CutSegment&) { return random() % 6 == 0; });
  expect_circle(join(cuts), 20, 0.3);
}

TEST(Join, LargeGapsAreClosedTowardsTheNearestStart) {
  std::vector<CutSegment> cuts = circle(40, 360);
  cuts.erase(cuts.begin() + 300, cuts.begin() + 330);
  cuts.erase(cuts.begin() + 100, cuts.begin() + 130);
  const auto contours = join(cuts);
  ASSERT_EQ(contours.size(), 1U);
  const double segment_mm2 = 0.5 * 1600 * (std::numbers::pi / 6 - 0.5);
  EXPECT_NEAR(area_of(contours[0]), std::numbers::pi * 1600 - 2 * segment_mm2, 0.5);
}

TEST(Join, OneOpenArcIsClosedByItsChord) {
  std::vector<CutSegment> cuts = circle(40, 360);
  cuts.resize(180);
  const auto contours = join(cuts);
  ASSERT_EQ(contours.size(), 1U);
  EXPECT_TRUE(is_closed(contours[0]));
  EXPECT_NEAR(area_of(contours[0]), 0.5 * std::numbers::pi * 1600, 1);
}

TEST(Join, ALoneSegmentIsClosedOnItself) {
  std::vector<CutSegment> cuts = circle(40, 360);
  cuts.resize(1);
  const auto contours = join(cuts);
  ASSERT_EQ(contours.size(), 1U);
  EXPECT_TRUE(is_closed(contours[0]));
  EXPECT_TRUE(join({}).empty());
}

TEST(Join, ClosesAnySoupOfManySegments) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> place(0, 200), step(-0.5, 0.5);
  std::vector<CutSegment> cuts;
  for (int i = 0; i < 20000; ++i) {
    const Vector2d a(place(random), place(random));
    // Some are points, and some mesh edges have several faces.
    const Vector2d b = i % 50 == 0 ? a : Vector2d(a + Vector2d(step(random), step(random)));
    const auto edge = static_cast<std::uint64_t>(i % 10 == 0 ? random() % 100 : 1000 + i);
    cuts.push_back({{a, b, {1, 0}, {0, 1}}, edge, 100000U + static_cast<std::uint64_t>(i)});
  }
  std::size_t segments = 0;
  for (const Contour& contour : join(cuts)) {
    EXPECT_TRUE(is_closed(contour));
    segments += contour.size();
  }
  EXPECT_GE(segments, cuts.size());
}

}  // namespace
}  // namespace hydroprint::waterline
