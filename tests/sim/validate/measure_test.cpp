#include "sim/validate/measure.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hydroprint::validate {
namespace {

TEST(Summary, LeavesOutNonFiniteValues) {
  const Summary s = summarise({3, std::nan(""), 1, HUGE_VAL, 2});
  EXPECT_EQ(s.count, 3U);
  EXPECT_DOUBLE_EQ(s.mean, 2);
  EXPECT_DOUBLE_EQ(s.rms, std::sqrt(14.0 / 3));
  EXPECT_EQ(s.p50, 2);
  EXPECT_EQ(s.max, 3);
  EXPECT_TRUE(std::isnan(summarise({}).mean));
  EXPECT_TRUE(std::isnan(summarise({std::nan("")}).max));
}

TEST(Share, IsByAreaAndOfTheRegionAlone) {
  mesh::Surface surface;  // a triangle of area 1/2 and a separate one of area 2
  surface.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {7, 0, 0}, {5, 2, 0}};
  surface.triangles = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_DOUBLE_EQ(share_where(surface, everywhere, [](std::size_t v) { return v < 3; }), 0.2);
  const Region right = [](const Eigen::Vector3d& p) { return p.x() > 3; };
  EXPECT_DOUBLE_EQ(share_where(surface, right, [](std::size_t v) { return v == 3; }), 1.0 / 3);
  const Region nowhere = [](const Eigen::Vector3d&) { return false; };
  EXPECT_EQ(share_where(surface, nowhere, [](std::size_t) { return true; }), 0);
}

TEST(LandingErrors, AreDistancesOnTheObject) {
  pipeline::Dip plan;
  plan.surface.points = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {10, 10, 0}};
  plan.surface.triangles = {{0, 1, 2}};
  flow::MappedTriangle tile;  // a tile whose film is stretched to twice its length along x
  tile.film_mm = {{{0, 0}, {5, 0}, {0, 10}}};
  for (int i = 0; i < 3; ++i) tile.barycentric[i] = Eigen::Vector3f::Unit(i);
  pipeline::Dip truth = plan;
  truth.map.tiles = {tile};
  const double nan = std::nan("");
  plan.map.surface.film_mm = {{0.1, 0}, {4.5, 0}, {50, 50}, {nan, nan}};
  const auto errors = landing_errors(plan, truth, {});
  ASSERT_TRUE(errors);
  EXPECT_NEAR((*errors)[0], 0.2, 1e-12);
  EXPECT_NEAR((*errors)[1], 1, 1e-12);
  EXPECT_EQ((*errors)[2], HUGE_VAL);
  EXPECT_TRUE(std::isnan((*errors)[3]));
}

}  // namespace
}  // namespace hydroprint::validate
