#include "sim/waterline/schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/sample/icosphere.h"
#include "tests/sim/support/bodies.h"

namespace hydroprint::waterline {
namespace {

bool has_within(const std::vector<double>& depths, double low, double high) {
  return std::any_of(depths.begin(), depths.end(), [&](double d) { return d >= low && d <= high; });
}

void expect_increasing_in(const std::vector<double>& depths, double depth_mm) {
  ASSERT_FALSE(depths.empty());
  EXPECT_GT(depths.front(), 0);
  EXPECT_LT(depths.back(), depth_mm);
  for (std::size_t i = 1; i < depths.size(); ++i) EXPECT_GT(depths[i], depths[i - 1]);
}

TEST(Schedule, DividesASphereEvenlyInTheta) {
  const double radius = 40;
  const Body body = testing::body_of(sample::icosphere(radius, 5));
  const ScheduleOptions options;
  const auto depths = schedule(body, body.height_mm, options).depths_mm;
  expect_increasing_in(depths, body.height_mm);
  int tested = 0;
  for (std::size_t i = 1; i < depths.size(); ++i) {
    const double before = std::acos(1 - depths[i - 1] / radius);
    const double after = std::acos(1 - depths[i] / radius);
    if (before < 60 * std::numbers::pi / 180 || after > 160 * std::numbers::pi / 180) continue;
    EXPECT_NEAR((after - before) * radius / options.swept_mm, 1, 0.1) << depths[i];
    ++tested;
  }
  EXPECT_GT(tested, 20);
}

TEST(Schedule, IsCloserWhereTheSurfaceBendsSharply) {
  // A drum with a rounded rim: from level to upright within a quarter circle.
  const double bend = 6, radius = 40;
  std::vector<Eigen::Vector2d> profile{{0, 0}};
  for (int i = 0; i <= 18; ++i) {
    const double theta = i * std::numbers::pi / 36;
    profile.emplace_back(radius - bend + bend * std::sin(theta), bend * (1 - std::cos(theta)));
  }
  profile.emplace_back(radius, 80);
  profile.emplace_back(0, 80);
  const Body body = testing::body_of(testing::turned(profile, 96));
  const ScheduleOptions options;
  const auto depths = schedule(body, body.height_mm, options).depths_mm;
  int tested = 0;
  for (std::size_t i = 1; i < depths.size(); ++i) {
    const double before = std::acos(std::clamp(1 - depths[i - 1] / bend, -1.0, 1.0));
    const double after = std::acos(std::clamp(1 - depths[i] / bend, -1.0, 1.0));
    if (before < 60 * std::numbers::pi / 180 || depths[i] > bend) continue;
    EXPECT_LT((after - before) * bend, 0.6 * options.swept_mm) << depths[i];
    ++tested;
  }
  EXPECT_GE(tested, 1);
}

TEST(Schedule, StartsJustAfterContactAndEndsJustBeforeTheTop) {
  const Body body = testing::body_of(sample::icosphere(40, 4));
  const ScheduleOptions options;
  const auto depths = schedule(body, body.height_mm, options).depths_mm;
  EXPECT_NEAR(depths.front(), options.event_gap_mm, 1e-12);
  EXPECT_NEAR(depths.back(), body.height_mm - options.event_gap_mm, 1e-9);
}

TEST(Schedule, EndsAtTheRequestedDepth) {
  const Body body = testing::body_of(sample::icosphere(40, 4));
  const auto depths = schedule(body, 23.5).depths_mm;
  expect_increasing_in(depths, 23.5);
  EXPECT_NEAR(depths.back(), 23.5, 0.01);
}

TEST(Schedule, TakesBothSidesOfAShelf) {
  // A box 10 mm high on a smaller box 10 mm high, so that a level face looks down at 10 mm.
  const Body body =
      testing::body_of(testing::blocks({-20, -10, 10, 20}, {-10, 10}, {0, 10, 20},
                                       [](int i, int, int k) { return k == 1 || i == 1; }));
  const ScheduleOptions options;
  const auto depths = schedule(body, body.height_mm, options).depths_mm;
  expect_increasing_in(depths, body.height_mm);
  const double gap = 1.5 * options.event_gap_mm;
  EXPECT_TRUE(has_within(depths, 10 - gap, 10 - 1e-9));
  EXPECT_TRUE(has_within(depths, 10 + 1e-9, 10 + gap));
}

TEST(Schedule, TakesBothSidesOfALevelEdge) {
  // A cone that continues as a cylinder.
  const Body body = testing::body_of(testing::turned({{0, 0}, {15, 15}, {15, 30}, {0, 30}}, 64));
  const ScheduleOptions options;
  const auto depths = schedule(body, body.height_mm, options).depths_mm;
  EXPECT_TRUE(has_within(depths, 15 - 1.5 * options.event_gap_mm, 15 - 1e-9));
  EXPECT_TRUE(has_within(depths, 15 + 1e-9, 15 + 1.5 * options.edge_gap_mm));
}

TEST(Schedule, HalvingTheSweptWidthDoublesTheSteps) {
  const Body body = testing::body_of(sample::icosphere(40, 4));
  ScheduleOptions options;
  const auto coarse = schedule(body, body.height_mm, options).depths_mm;
  options.swept_mm /= 2;
  const auto fine = schedule(body, body.height_mm, options).depths_mm;
  EXPECT_NEAR(static_cast<double>(fine.size()) / static_cast<double>(coarse.size()), 2, 0.1);
}

TEST(Schedule, LengthensItsStepsToKeepWithinTheLimit) {
  const Body body = testing::body_of(sample::icosphere(40, 4));
  const ScheduleOptions usual;
  ScheduleOptions few;
  few.most = 24;
  const Schedule all = schedule(body, body.height_mm, usual);
  const Schedule some = schedule(body, body.height_mm, few);
  EXPECT_EQ(all.widening, 1);
  EXPECT_LE(some.depths_mm.size(), 18U);  // the rest is for changes of the topology
  EXPECT_GE(some.depths_mm.size(), 12U);
  EXPECT_NEAR(some.widening * 12, static_cast<double>(all.depths_mm.size()), 3);
  expect_increasing_in(some.depths_mm, body.height_mm);
}

TEST(Schedule, KeepsTheLargestOfTooManyLevels) {
  // A stair whose steps become narrower upwards.
  std::vector<double> planes, levels;
  for (int i = 0; i <= 20; ++i) {
    planes.push_back(-i * (20 + i) / 4.0);
    levels.push_back(4 * i);
  }
  std::reverse(planes.begin(), planes.end());
  const Body body = testing::body_of(
      testing::blocks(planes, {-10, 10}, levels, [](int i, int, int k) { return i + k >= 19; }));
  ScheduleOptions options;
  options.most = 40;
  const Schedule some = schedule(body, body.height_mm, options);
  EXPECT_LE(some.depths_mm.size(), 30U);
  ASSERT_FALSE(some.left_out_mm.empty());
  const double gap = 1.5 * options.event_gap_mm;
  const auto has_both_sides = [&](double level) {
    return has_within(some.depths_mm, level - gap, level - 1e-9) &&
           has_within(some.depths_mm, level + 1e-9, level + gap);
  };
  int kept = 0;
  for (int k = 1; k < 20; ++k) {
    const bool is_left_out = std::any_of(some.left_out_mm.begin(), some.left_out_mm.end(),
                                         [&](double d) { return std::abs(d - 4 * k) < 1e-6; });
    EXPECT_NE(has_both_sides(4 * k), is_left_out) << 4 * k;
    kept += is_left_out ? 0 : 1;
  }
  EXPECT_GT(kept, 2);
  // The widest steps are the highest.
  EXPECT_TRUE(has_both_sides(4 * 19));
}

TEST(Schedule, StartsAndEndsFurtherFromALevelEdge) {
  // A square bar that stands on an edge: a needle 2 um after the contact.
  const Body body = testing::body_of(testing::turned({{10, 0}, {20, 10}, {10, 20}, {0.5, 10}}, 64));
  const ScheduleOptions options;
  const auto depths = schedule(body, body.height_mm, options).depths_mm;
  EXPECT_NEAR(depths.front(), options.edge_gap_mm, 1e-9);
  EXPECT_NEAR(depths.back(), body.height_mm - options.edge_gap_mm, 1e-9);
}

TEST(Schedule, OfABodyWithoutHeightIsEmpty) {
  mesh::Model model;
  model.path = "sheet";
  model.vertices = {{0, 0, 0}, {5, 0, 0}, {0, 5, 0}};
  model.triangles = {{0, 1, 2}};
  EXPECT_TRUE(schedule(testing::body_of(model), 0).depths_mm.empty());
}

}  // namespace
}  // namespace hydroprint::waterline
