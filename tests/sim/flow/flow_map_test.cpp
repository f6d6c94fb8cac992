#include "sim/flow/flow_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/sample/icosphere.h"
#include "sim/velocity/quadratic_elements.h"
#include "tests/sim/support/bodies.h"
#include "tests/sim/support/dips.h"

namespace hydroprint::flow {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::DipSetting;
using testing::SolvedDip;

FlowMap mapped(const SolvedDip& dip, MapOptions options = {}) {
  options.make_tiles = false;
  return make_flow_map(dip.surface, dip.body, dip.field, {}, options, {}).value();
}

/// Expects that the values at each point are either all numbers or all NaN.
void expect_numbers_or_nothing(const SurfaceMap& map) {
  for (std::size_t v = 0; v < map.film_mm.size(); ++v) {
    const bool reached = !std::isnan(map.film_mm[v].x());
    EXPECT_EQ(map.film_mm[v].allFinite(), reached);
    EXPECT_EQ(std::isfinite(map.contact_time_s[v]), reached);
    EXPECT_FALSE(std::isinf(map.stretch[v]) || std::isinf(map.least_stretch[v]));
    if (reached) continue;
    EXPECT_TRUE(std::isnan(map.film_mm[v].y()));
    EXPECT_TRUE(std::isnan(map.contact_time_s[v]));
    EXPECT_TRUE(std::isnan(map.stretch[v]));
    EXPECT_TRUE(std::isnan(map.least_stretch[v]));
  }
}

TEST(FlowMap, IsEmptyBeyondTheDepthOfTheDip) {
  DipSetting setting;
  setting.film = testing::film_of("100x100");
  setting.depth_mm = 12;
  const SolvedDip dip = testing::solve_dip(sample::icosphere(20, 4), setting);
  const FlowMap map = mapped(dip);
  expect_numbers_or_nothing(map.surface);
  for (std::size_t v = 0; v < map.surface.film_mm.size(); ++v) {
    EXPECT_EQ(std::isnan(map.surface.film_mm[v].x()), dip.body.points_mm[v].z() > 12)
        << dip.body.points_mm[v].transpose();
  }
}

TEST(RestMap, GivesFilmBeyondItTheRestPositionOfTheNearestNode) {
  DipSetting setting;
  setting.film = testing::film_of("100x100");
  setting.depth_mm = 20;
  const DipField small = testing::solve_dip(sample::icosphere(15, 3), setting).field;
  const DipField large = testing::solve_dip(sample::icosphere(30, 3), setting).field;
  const std::size_t last = small.fields.size() - 1, other = large.fields.size() - 1;
  // The film around the large sphere has a larger hole than that around the small one.
  const RestMap known{last, large.fields[other].with(trace_back(large, other))};
  const std::vector<Vector2d> rest_mm = trace_back(small, last, &known);
  int beyond = 0;
  for (std::size_t n = 0; n < rest_mm.size(); ++n) {
    ASSERT_TRUE(rest_mm[n].allFinite()) << n;
    const Vector2d place = velocity::place_of(small.fields[last].mesh(), n);
    if (place.norm() > 20) continue;
    ++beyond;
    EXPECT_NEAR((rest_mm[n].normalized() - place.normalized()).norm(), 0, 0.2) << "another side";
  }
  EXPECT_GT(beyond, 20);
}

TEST(FlowMap, IsEmptyInACupMouthUp) {
  DipSetting setting;
  setting.film = testing::film_of("100x100");
  const SolvedDip dip = testing::solve_dip(testing::cup(12, 16, 25, 4, true, 48), setting);
  const FlowMap map = mapped(dip);
  expect_numbers_or_nothing(map.surface);
  int walls = 0;
  for (std::size_t v = 0; v < map.surface.film_mm.size(); ++v) {
    const Vector3d& p = dip.body.points_mm[v];
    const double r = p.head<2>().norm();
    const bool is_inside = r < 12.1 && p.z() > 3.9;
    const bool is_outside_wall = r > 15.8 && p.z() < 24.9;
    if (is_inside) {
      EXPECT_TRUE(std::isnan(map.surface.film_mm[v].x())) << p.transpose();
    } else if (is_outside_wall) {
      EXPECT_TRUE(map.surface.film_mm[v].allFinite()) << p.transpose();
      ++walls;
    }
  }
  EXPECT_GT(walls, 500);
}

TEST(FlowMap, IsEmptyInsideTheUnionOfTheParts) {
  DipSetting setting;
  setting.film = testing::film_of("100x100");
  setting.depth_mm = 14;
  const SolvedDip dip =
      testing::solve_dip(testing::together({testing::box({-20, -10, 0}, {4, 10, 15}),
                                            testing::box({-4, -7, 0}, {20, 7, 15})}),
                         setting);
  const FlowMap map = mapped(dip);
  const auto depth_in = [](const Vector3d& p, double x_low, double x_high, double y_half) {
    return std::min({p.x() - x_low, x_high - p.x(), p.y() + y_half, y_half - p.y()});
  };
  int buried = 0;
  for (std::size_t v = 0; v < map.surface.film_mm.size(); ++v) {
    const Vector3d& p = dip.body.points_mm[v];
    if (p.z() < 1 || p.z() > 14) continue;
    const double depth = std::max(depth_in(p, -20, 4, 10), depth_in(p, -4, 20, 7));
    if (depth > 0.2) {
      EXPECT_TRUE(std::isnan(map.surface.film_mm[v].x())) << p.transpose();
      ++buried;
    } else if (depth < 1e-6) {
      EXPECT_TRUE(map.surface.film_mm[v].allFinite()) << p.transpose();
    }
  }
  EXPECT_GT(buried, 50);
}

TEST(FlowMap, IsEmptyWhereFilmCannotFollow) {
  DipSetting setting;
  setting.film = testing::film_of("80x80");
  const SolvedDip dip = testing::solve_dip(sample::icosphere(15, 5), setting);
  const FlowMap map = mapped(dip);
  int beyond = 0;
  for (std::size_t v = 0; v < map.surface.film_mm.size(); ++v) {
    const double cosine = -dip.surface.points[v].normalized().z();
    if (cosine > std::cos(176 * std::numbers::pi / 180)) continue;
    EXPECT_TRUE(std::isnan(map.surface.film_mm[v].x()));
    ++beyond;
  }
  EXPECT_GT(beyond, 10);
}

TEST(FlowMap, IsEmptyInACupWithAWallOfATenthOfAMillimetre) {
  DipSetting setting;
  setting.film = testing::film_of("80x80");
  const SolvedDip dip = testing::solve_dip(testing::cup(12, 12.1, 20, 4, true, 64), setting);
  const FlowMap map = mapped(dip);
  int inside = 0;
  for (std::size_t v = 0; v < map.surface.film_mm.size(); ++v) {
    const Vector3d& p = dip.body.points_mm[v];
    if (p.head<2>().norm() > 12.001 || p.z() < 4.5 || p.z() > 19) continue;
    EXPECT_TRUE(std::isnan(map.surface.film_mm[v].x())) << p.transpose();
    ++inside;
  }
  EXPECT_GT(inside, 500);
}

TEST(FlowMap, OfASwollenFilmIsGivenOnTheFilmAsPrinted) {
  DipSetting setting;
  setting.film = testing::film_of("100x100");
  setting.depth_mm = 15;
  const SolvedDip dip = testing::solve_dip(sample::icosphere(20, 3), setting);
  MapOptions options;
  const FlowMap floating = mapped(dip, options);
  options.swelling = {1.1, 1.25};
  const FlowMap printed = mapped(dip, options);
  for (std::size_t v = 0; v < floating.surface.film_mm.size(); ++v) {
    const Vector2d& p = floating.surface.film_mm[v];
    if (std::isnan(p.x())) continue;
    const Vector2d expected(p.x() / 1.1, p.y() / 1.25);
    EXPECT_LT((printed.surface.film_mm[v] - expected).norm(), 1e-12);
  }
}

TEST(FlowMap, CoincidentPointsHaveOneFilmPoint) {
  // As from an STL file: every face has its own corners.
  const mesh::Model sphere = sample::icosphere(15, 3);
  mesh::Model torn;
  torn.path = "torn";
  for (const Eigen::Vector3i& t : sphere.triangles) {
    const int n = static_cast<int>(torn.vertices.size());
    for (const int v : t) torn.vertices.push_back(sphere.vertices[v]);
    torn.triangles.emplace_back(n, n + 1, n + 2);
  }
  DipSetting setting;
  setting.film = testing::film_of("80x80");
  setting.max_edge_mm = 50;
  setting.depth_mm = 22;
  setting.coarsen(2);
  const SolvedDip dip = testing::solve_dip(torn, setting);
  const FlowMap map = mapped(dip);
  const FlowMap whole = mapped(testing::solve_dip(sphere, setting));
  for (std::size_t t = 0; t < sphere.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const Vector2d& got = map.surface.film_mm[3 * t + i];
      const Vector2d& expected = whole.surface.film_mm[sphere.triangles[t][i]];
      EXPECT_EQ(std::isnan(got.x()), std::isnan(expected.x()));
      if (std::isnan(got.x())) continue;
      EXPECT_LT((got - expected).norm(), 0.01);
    }
  }
}

TEST(FlowMap, StopsWhenCancelled) {
  DipSetting setting;
  setting.film = testing::film_of("80x80");
  setting.depth_mm = 3;
  const SolvedDip dip = testing::solve_dip(sample::icosphere(15, 3), setting);
  Context context;
  context.cancelled = [] { return true; };
  for (const bool tiles : {false, true}) {
    MapOptions options;
    options.make_tiles = tiles;
    const auto map = make_flow_map(dip.surface, dip.body, dip.field, {}, options, context);
    ASSERT_FALSE(map);
    EXPECT_EQ(map.error().code, Code::kCancelled);
  }
}

TEST(TraceBack, OfALandingOffTheFilmOrPastTheDipIsEmpty) {
  DipSetting setting;
  setting.film = testing::film_of("80x80");
  setting.depth_mm = 10;
  const SolvedDip dip = testing::solve_dip(sample::icosphere(15, 3), setting);
  const Vector2d rest(0, 0);
  EXPECT_FALSE(trace_back(dip.field, {Vector2d(41, 0), 0, rest, true, true}));
  EXPECT_FALSE(trace_back(dip.field, {Vector2d(41, 0), 5, rest, true, true}));
  EXPECT_FALSE(trace_back(dip.field, {Vector2d(0, 0), 10.001, rest, true, true}));
  EXPECT_FALSE(trace_back(dip.field, {Vector2d(0, 0), 8, rest, true, true})) << "inside the body";
  EXPECT_TRUE(trace_back(dip.field, {Vector2d(30, 30), 8, rest, true, true}))
      << "a point of the floating film";
}

}  // namespace
}  // namespace hydroprint::flow
