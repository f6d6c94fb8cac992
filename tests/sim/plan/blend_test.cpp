#include "sim/plan/blend.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sim/sample/icosphere.h"
#include "tests/sim/plan/fields.h"
#include "tests/sim/support/bodies.h"

namespace hydroprint::plan {
namespace {

using testing::nearest_point;
using testing::stretch_of;
using testing::surface_of;
using Place = Eigen::Vector3d;

constexpr double kNever = std::numeric_limits<double>::infinity();

/// A surface with its weights.
struct Blend {
  Blend(mesh::Surface surface_, const Stretch& stretch, double blend_mm = kBlend_mm)
      : surface(std::move(surface_)),
        regions(make_regions(surface, stretch, {}, {}).value()),
        weights(BlendWeights::create(surface, regions, blend_mm, {}).value()) {}

  [[nodiscard]] std::vector<double> at(const Place& place) const {
    const auto point = nearest_point(surface, place);
    return weights.at(point.triangle, point.barycentric);
  }

  mesh::Surface surface;
  Regions regions;
  BlendWeights weights;
};

/// Weight of the nearer of two dips at a distance from the seam.
double own_weight(double distance_mm) {
  return 1 / (1 + std::max(0.0, 1 - distance_mm / kBlend_mm));
}

TEST(Blend, FallsOverTheWidthOnBothSidesOfTheEquator) {
  const auto surface = surface_of(sample::icosphere(40, 4));
  const auto stretch = stretch_of(surface, {[](const Place& p) { return 1 / (1.3 + p.z() / 40); },
                                            [](const Place& p) { return 1 / (1.3 - p.z() / 40); }});
  const Blend blend(surface, stretch);
  for (const auto& point : testing::random_points(surface, 20000, 7)) {
    const double latitude = std::asin(point.place.z() / point.place.norm());
    const double own = own_weight(40 * std::abs(latitude));
    const double expected = latitude > 0 ? own : 1 - own;
    const auto weights = blend.weights.at(point.triangle, point.barycentric);
    ASSERT_NEAR(weights[0], expected, 0.02) << latitude;
    ASSERT_NEAR(weights[0] + weights[1], 1, 1e-6);
  }
}

TEST(Blend, WidthIsAnOption) {
  const auto surface =
      surface_of(testing::rectangle({-20, -20, 0}, {40, 0, 0}, {0, 40, 0}, 20, 20), 3);
  const Blend blend(surface, testing::two_dips(surface, {1, 0, 0}), 12);
  EXPECT_NEAR(blend.at({6, 0.3, 0})[1], 0.5 / 1.5, 1e-6);
  EXPECT_NEAR(blend.at({-3, 0.3, 0})[0], 0.75 / 1.75, 1e-6);
  EXPECT_EQ(blend.at({12.1, 0.3, 0})[1], 0);
}

TEST(Blend, SidesOfAThinPlateDoNotBlend) {
  const auto surface = surface_of(testing::box({-40, -40, -1}, {40, 40, 1}));
  const Blend blend(surface, testing::two_dips(surface, {0, 0, 1}));
  EXPECT_EQ(blend.at({0, 0, 1})[0], 1);
  EXPECT_EQ(blend.at({0, 0, -1})[0], 0);
  // The seam runs around the rim at half its height.
  EXPECT_NEAR(blend.at({38.5, 3, 1})[0], own_weight(2.5), 1e-6);
  EXPECT_EQ(blend.at({35.9, 3, 1})[0], 1);
  EXPECT_NEAR(blend.at({5, -38.5, -1})[1], own_weight(2.5), 1e-6);
}

TEST(Blend, ShellsCloseToEachOtherDoNotBlend) {
  const auto surface = surface_of(
      testing::together({testing::rectangle({-20, -20, 0}, {40, 0, 0}, {0, 40, 0}, 20, 20),
                         testing::rectangle({-20, -20, 0.5}, {40, 0, 0}, {0, 40, 0}, 20, 20)}));
  const auto stretch =
      stretch_of(surface, {[](const Place& p) { return p.z() > 0.2 ? 200 : 100 - p.x(); },
                           [](const Place& p) { return 100 + p.x(); }});
  const Blend blend(surface, stretch);
  EXPECT_NEAR(blend.at({1, 0, 0})[0], own_weight(1), 1e-6);
  EXPECT_EQ(blend.at({1, 0, 0.5})[0], 0);
  EXPECT_EQ(blend.at({-1, 0, 0.5})[1], 1);
}

TEST(Blend, SheetsThatTouchInOnePointDoNotBlend) {
  const auto surface = surface_of(
      testing::together({testing::rectangle({-20, -20, 0}, {20, 0, 0}, {0, 20, 0}, 10, 10),
                         testing::rectangle({0, 0, 0}, {20, 0, 0}, {0, 20, 0}, 10, 10)}),
      3);
  const Blend blend(surface, testing::two_dips(surface, {1, 1, 0}));
  EXPECT_EQ(blend.at({0.5, 0.4, 0})[0], 1);
  EXPECT_EQ(blend.at({-0.5, -0.4, 0})[1], 1);
  EXPECT_TRUE(blend.regions.seam.empty());
}

TEST(Blend, CrossesAnEdgeOfThreeSheets) {
  std::vector<mesh::Model> sheets;
  for (const double angle : {0.0, 2.0, 4.0})
    sheets.push_back(testing::rectangle({0, 0, 0}, {40, 0, 0},
                                        {0, 20 * std::cos(angle), 20 * std::sin(angle)}, 20, 10));
  const auto surface = surface_of(testing::together(sheets));
  // The first sheet belongs to dip 1 beyond 2 mm from the common edge.
  const auto along = [](const Place& p) {
    return std::abs(p.z()) < 1e-9 && p.y() > 0 ? p.y() : -std::hypot(p.y(), p.z());
  };
  const Blend blend(surface, stretch_of(surface, {[&](const Place& p) { return 102 - along(p); },
                                                  [&](const Place& p) { return 98 + along(p); }}));
  EXPECT_NEAR(blend.at({20.3, 3, 0})[0], own_weight(1), 1e-6);
  for (const double angle : {2.0, 4.0})
    EXPECT_NEAR(blend.at({20.3, std::cos(angle), std::sin(angle)})[0], 1 - own_weight(3), 1e-6);
}

TEST(Blend, GoesAroundTheCornersOfAnOpenSheet) {
  // A sheet with a slot from x = 0 to the right, so that the two arms only meet around its end.
  mesh::Model model = testing::rectangle({-20, -20, 0}, {40, 0, 0}, {0, 40, 0}, 20, 20);
  std::erase_if(model.triangles, [&](const Eigen::Vector3i& t) {
    const Place centre = (model.vertices[std::size_t(t[0])] + model.vertices[std::size_t(t[1])] +
                          model.vertices[std::size_t(t[2])]) /
                         3;
    return centre.x() > 0 && centre.y() > 0 && centre.y() < 2;
  });
  const auto surface = surface_of(model);
  // Dip 1 has a part of the lower arm: x > 2 and y < -2.
  const auto stretch =
      stretch_of(surface, {[](const Place& p) { return 100 + std::max(p.y() + 2, 2 - p.x()); },
                           [](const Place& p) { return 100 - std::max(p.y() + 2, 2 - p.x()); }});
  const Blend blend(surface, stretch, 8);
  // The shortest path runs from (2, -2) over the corners (0, 0) and (0, 2) of the slot.
  const double distance = std::sqrt(8.0) + 2 + std::hypot(1.0, 0.5);
  const auto weights = blend.at({1, 2.5, 0});
  EXPECT_NEAR(weights[0] / weights[1], 1 - distance / 8, 1e-6);
}

TEST(Blend, IsZeroOutsideTheReachAndFallsBeforeItsEnd) {
  const auto surface =
      surface_of(testing::rectangle({-20, -20, 0}, {40, 0, 0}, {0, 40, 0}, 20, 20), 3);
  // Dip 1 has less stretch everywhere, but ends at x = 0.
  const auto stretch =
      stretch_of(surface, {[](const Place& p) { return p.x() > 0.1 ? kNever : 1.0; },
                           [](const Place&) { return 2.0; }});
  const Blend blend(surface, stretch);
  EXPECT_EQ(blend.at({0.1, 0.3, 0})[0], 0);
  EXPECT_EQ(blend.at({-5.1, 0.3, 0})[0], 1);
  for (const double d : {0.01, 1.0, 2.5, 4.5}) {
    const double own = d / 5;        // falls to zero at the end of the reach
    const double other = 1 - d / 5;  // distance from region 2, which begins there
    EXPECT_NEAR(blend.at({-d, 0.3, 0})[0], own / (own + other), 1e-6) << d;
  }
}

TEST(Blend, OnlyDipHasWeightOneUpToTheEndOfItsReach) {
  const auto surface =
      surface_of(testing::rectangle({-20, -20, 0}, {40, 0, 0}, {0, 40, 0}, 20, 20), 3);
  const auto stretch =
      stretch_of(surface, {[](const Place& p) { return p.x() > 0.1 ? kNever : 1.0; },
                           [](const Place& p) { return p.x() < 10.1 ? kNever : 2.0; }});
  const Blend blend(surface, stretch);
  EXPECT_EQ(blend.at({-0.001, 0.3, 0})[0], 1);
  EXPECT_EQ(blend.at({5, 0.3, 0}), (std::vector<double>{0, 0}));  // no dip reaches this part
  EXPECT_EQ(blend.at({12.001, 0.3, 0})[1], 1);
  EXPECT_NEAR(blend.regions.unreached_share, 12.0 / 40, 1e-9);
}

TEST(Blend, AdjoiningReachesWithoutOverlapDoNotBlend) {
  const auto surface =
      surface_of(testing::rectangle({-20, -20, 0}, {40, 0, 0}, {0, 40, 0}, 20, 20), 3);
  const auto stretch =
      stretch_of(surface, {[](const Place& p) { return p.x() > 0.1 ? kNever : 1.0; },
                           [](const Place& p) { return p.x() < -0.1 ? kNever : 2.0; }});
  const Blend blend(surface, stretch);
  EXPECT_NEAR(blend.at({-0.001, 0.3, 0})[0], 1, 1e-12);
  EXPECT_NEAR(blend.at({0.001, 0.3, 0})[1], 1, 1e-12);
  EXPECT_NEAR(blend.regions.seam_mm, 40, 1e-9);
}

TEST(Blend, OneDipHasWeightOne) {
  const auto surface = surface_of(sample::icosphere(20, 2));
  const Blend blend(surface, stretch_of(surface, {[](const Place&) { return 1.0; }}));
  for (const auto& point : testing::random_points(surface, 200, 1))
    EXPECT_EQ(blend.weights.at(point.triangle, point.barycentric), std::vector<double>{1});
}

TEST(Blend, DipGivenTwiceHasWeightZero) {
  const auto surface = surface_of(sample::icosphere(20, 2));
  auto stretch = testing::two_dips(surface, {1, 0, 0});
  stretch.push_back(stretch[0]);
  const Blend blend(surface, stretch);
  for (const auto& point : testing::random_points(surface, 200, 1))
    EXPECT_EQ(blend.weights.at(point.triangle, point.barycentric)[2], 0);
}

TEST(Blend, ValuesAtPointsAreThoseOfTheirPlaces) {
  const auto surface = surface_of(testing::box({-10, -10, -10}, {10, 10, 10}));
  const Blend blend(surface, testing::two_dips(surface, {1, 0.3, 0.2}));
  const auto values = blend.weights.at_points(surface, {}).value();
  ASSERT_EQ(values.size(), 2U);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (int c = 0; c < 3; ++c) {
      const auto p = std::size_t(surface.triangles[t][c]);
      const auto weights = blend.weights.at(int(t), Place::Unit(c));
      EXPECT_NEAR(values[0][p], weights[0], 1e-6);
      EXPECT_NEAR(values[1][p], weights[1], 1e-6);
    }
}

TEST(Blend, BadWidthIsRefusedAndCancellationEndsTheWork) {
  const auto surface = surface_of(sample::icosphere(20, 3));
  const auto regions = make_regions(surface, testing::two_dips(surface, {1, 0, 0}), {}, {}).value();
  for (const double width : {0.0, -1.0, std::nan(""), kNever}) {
    const auto weights = BlendWeights::create(surface, regions, width, {});
    ASSERT_FALSE(weights);
    EXPECT_EQ(weights.error().code, Code::kInvalidArgument);
  }
  Context context;
  context.cancelled = [] { return true; };
  const auto weights = BlendWeights::create(surface, regions, 5, context);
  ASSERT_FALSE(weights);
  EXPECT_EQ(weights.error().code, Code::kCancelled);
}

}  // namespace
}  // namespace hydroprint::plan
