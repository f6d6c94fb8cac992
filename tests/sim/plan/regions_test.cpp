#include "sim/plan/regions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sim/mesh/make_surface.h"
#include "sim/plan/facets.h"
#include "sim/sample/icosphere.h"
#include "tests/sim/plan/fields.h"
#include "tests/sim/support/bodies.h"

namespace hydroprint::plan {
namespace {

using testing::stretch_of;
using testing::surface_of;
using Point = Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSphereMm2 = 4 * M_PI * 40 * 40;

Regions regions_of(const mesh::Surface& surface, const Stretch& stretch, double min_mm2 = 25) {
  auto regions = make_regions(surface, stretch, {min_mm2}, {});
  EXPECT_TRUE(regions) << regions.error().message;
  return *regions;
}

mesh::Surface flat_sheet() {
  return surface_of(testing::rectangle({-20, -20, 0}, {40, 0, 0}, {0, 40, 0}, 25, 25), 3);
}

/// Stretch 1 everywhere against stretch 2, except within a radius of a point, where it is lower.
Stretch with_island(const mesh::Surface& surface, double radius_mm) {
  return stretch_of(surface, {[](const Point&) { return 1.0; },
                              [=](const Point& p) { return 1 + (p.norm() - radius_mm) / 10; }});
}

TEST(Regions, SphereIsDividedAtTheEquatorInsideTriangles) {
  const auto surface = surface_of(sample::icosphere(40, 4));
  const auto stretch = stretch_of(surface, {[](const Point& p) { return 1 / (1.3 + p.z() / 40); },
                                            [](const Point& p) { return 1 / (1.3 - p.z() / 40); }});
  const Regions regions = regions_of(surface, stretch);
  ASSERT_FALSE(regions.seam.empty());
  for (const auto& segment : regions.seam) {
    EXPECT_LT(std::abs(segment.from.z()), 0.06);
    EXPECT_LT(std::abs(segment.to.z()), 0.06);
    EXPECT_EQ(segment.dip, 1);
    EXPECT_EQ(segment.other_dip, 2);
  }
  EXPECT_NEAR(regions.seam_mm, 2 * M_PI * 40, 0.3);
  for (const auto& size : regions.sizes) {
    EXPECT_EQ(size.pieces, 1);
    EXPECT_NEAR(size.area_mm2, kSphereMm2 / 2, 0.005 * kSphereMm2);
  }
  EXPECT_EQ(regions.unreached_share, 0);
}

TEST(Regions, FragmentsTileTheSurfaceAndHaveTheLeastStretch) {
  const auto surface = surface_of(sample::icosphere(30, 2));
  std::vector<std::function<double(const Point&)>> dips;
  for (int k = 0; k < 6; ++k)
    dips.emplace_back([k](const Point& p) {
      return 3 + std::sin(p.x() / 9 + 2 * k) + std::cos(p.y() / 7 - k) * std::sin(p.z() / 8 + k);
    });
  const auto stretch = stretch_of(surface, dips);
  const Regions regions = regions_of(surface, stretch, 0);
  const auto& fragments = regions.fragments;
  std::vector<double> covered(surface.triangles.size(), 0);
  for (std::size_t f = 0; f < fragments.all.size(); ++f) {
    const auto& fragment = fragments.all[f];
    covered[std::size_t(fragment.triangle)] += fragments.share(f);
    Point centre = Point::Zero();
    for (const auto& corner : fragments.polygon(f)) centre += corner;
    centre /= double(fragment.corners);
    const auto value = [&](std::size_t k) {
      double sum = 0;
      for (int i = 0; i < 3; ++i) {
        const int point = surface.triangles[std::size_t(fragment.triangle)][i];
        sum += centre[i] * stretch[k][std::size_t(point)];
      }
      return sum;
    };
    for (std::size_t k = 0; k < dips.size(); ++k)
      EXPECT_LE(value(std::size_t(fragment.dip - 1)), value(k) + 1e-9);
    EXPECT_EQ(fragments.find(fragment.triangle, centre), f);
  }
  for (const double share : covered) EXPECT_NEAR(share, 1, 1e-9);
}

TEST(Regions, DipGivenTwiceLeavesTheSecondRegionEmpty) {
  const auto surface = surface_of(sample::icosphere(40, 3));
  const auto wave = [](const Point& p) { return 2 + std::sin(p.x() / 5); };
  const Regions regions = regions_of(surface, stretch_of(surface, {wave, wave}));
  EXPECT_EQ(regions.sizes[0].pieces, 1);
  EXPECT_NEAR(regions.sizes[0].area_mm2, kSphereMm2, 0.02 * kSphereMm2);
  EXPECT_EQ(regions.sizes[1].pieces, 0);
  EXPECT_EQ(regions.sizes[1].area_mm2, 0);
  EXPECT_TRUE(regions.seam.empty());
}

TEST(Regions, OneDipGetsAllThatItReaches) {
  const auto surface = flat_sheet();
  const auto stretch =
      stretch_of(surface, {[](const Point& p) { return p.x() > 10.1 ? kInfinity : 1.5; }});
  const Regions regions = regions_of(surface, stretch);
  EXPECT_EQ(regions.sizes[0].pieces, 1);
  EXPECT_TRUE(regions.seam.empty());  // nothing is beyond the end of the reach
  // The column of squares with one infinite side is not reached: x > 8.8 (squares of 1.6 mm).
  EXPECT_NEAR(regions.unreached_share, (20 - 8.8) / 40, 1e-9);
  EXPECT_NEAR(regions.sizes[0].area_mm2, 40 * 28.8, 1e-6);
}

TEST(Regions, WholeTrianglesAreReachedOrNot) {
  const auto surface = flat_sheet();
  auto stretch = stretch_of(surface, {[](const Point&) { return 1.0; }});
  stretch[0][std::size_t(surface.triangles[100][0])] = kInfinity;
  const Regions regions = regions_of(surface, stretch);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    bool is_finite = true;
    for (int i = 0; i < 3; ++i)
      is_finite = is_finite && stretch[0][std::size_t(surface.triangles[t][i])] < 2;
    ASSERT_EQ(regions.fragments.of_triangle(int(t)).size(), 1U);
    EXPECT_EQ(regions.fragments.of_triangle(int(t))[0].dip, is_finite ? 1 : 0);
  }
}

TEST(Regions, SmallPiecesJoinTheirNeighbourAndLargeOnesStay) {
  const auto surface = flat_sheet();
  const Regions small = regions_of(surface, with_island(surface, 2));  // 12.6 mm2
  EXPECT_EQ(small.sizes[1].pieces, 0);
  EXPECT_EQ(small.sizes[0].pieces, 1);
  EXPECT_TRUE(small.seam.empty());
  const Regions large = regions_of(surface, with_island(surface, 4));  // 50.3 mm2
  EXPECT_EQ(large.sizes[1].pieces, 1);
  EXPECT_NEAR(large.sizes[1].area_mm2, M_PI * 16, 1.5);
  EXPECT_NEAR(large.seam_mm, 2 * M_PI * 4, 1);
  const Regions kept = regions_of(surface, with_island(surface, 2), 5);
  EXPECT_EQ(kept.sizes[1].pieces, 1);
}

TEST(Regions, PieceThatItsNeighbourDoesNotReachStays) {
  const auto surface = flat_sheet();
  auto stretch = with_island(surface, 2);
  for (std::size_t p = 0; p < surface.points.size(); ++p) {
    if (surface.points[p].norm() < 1.2) stretch[0][p] = kInfinity;
  }
  const Regions regions = regions_of(surface, stretch);
  EXPECT_EQ(regions.sizes[1].pieces, 1);
}

TEST(Regions, SmallPieceJoinsTheNeighbourWithTheLongestBorder) {
  const auto surface = flat_sheet();
  // Dip 3 has a square of 4 mm side next to the border of dips 1 and 2: one side of the square
  // touches dip 1, and three touch dip 2.
  const auto stretch = stretch_of(
      surface,
      {[](const Point& p) { return 2 + p.x() / 10; }, [](const Point& p) { return 2 - p.x() / 10; },
       [](const Point& p) {
         return 1.9 + std::max(std::abs(p.x() - 1.5), std::abs(p.y())) / 10 - 0.2;
       }});
  const Regions before = regions_of(surface, stretch, 0);
  ASSERT_GT(before.sizes[2].area_mm2, 5);
  const Regions regions = regions_of(surface, stretch);
  EXPECT_EQ(regions.sizes[2].pieces, 0);
  EXPECT_EQ(regions.sizes[0].pieces, 1);
  EXPECT_EQ(regions.sizes[1].pieces, 1);
  EXPECT_GT(regions.sizes[1].area_mm2, before.sizes[1].area_mm2 + before.sizes[2].area_mm2 - 1e-9);
}

TEST(Regions, IsolatedSmallShellStays) {
  const auto surface = surface_of(testing::together(
      {sample::icosphere(1, 2), testing::moved(sample::icosphere(20, 3), {40, 0, 0})}));
  const auto stretch = stretch_of(surface, {[](const Point& p) { return p.x() > 10 ? 1.0 : 2.0; },
                                            [](const Point& p) { return p.x() > 10 ? 2.0 : 1.0; }});
  const Regions regions = regions_of(surface, stretch);
  EXPECT_EQ(regions.sizes[0].pieces, 1);
  EXPECT_EQ(regions.sizes[1].pieces, 1);
  EXPECT_TRUE(regions.seam.empty());
}

TEST(Regions, PiecesAreConnectedAcrossEdgesOfThreeTriangles) {
  std::vector<mesh::Model> sheets;
  for (const double angle : {0.0, 2.0, 4.0})
    sheets.push_back(testing::rectangle({0, 0, 0}, {40, 0, 0},
                                        {0, 20 * std::cos(angle), 20 * std::sin(angle)}, 20, 10));
  const auto surface = surface_of(testing::together(sheets));
  const Regions regions = regions_of(surface, testing::two_dips(surface, {1, 0, 0}));
  EXPECT_EQ(regions.sizes[0].pieces, 1);
  EXPECT_EQ(regions.sizes[0].pieces + regions.sizes[1].pieces, 1);
  const Regions halves =
      regions_of(surface, stretch_of(surface, {[](const Point& p) { return p.x(); },
                                               [](const Point& p) { return 40.5 - p.x(); }}));
  EXPECT_EQ(halves.sizes[0].pieces, 1);
  EXPECT_EQ(halves.sizes[1].pieces, 1);
  EXPECT_NEAR(halves.seam_mm, 60, 1e-6);
}

TEST(Regions, SeamAlongAnEdgeOfThreeTrianglesIsCountedOnce) {
  std::vector<mesh::Model> sheets;
  for (const double angle : {0.0, 2.0, 4.0})
    sheets.push_back(testing::rectangle({0, 0, 0}, {40, 0, 0},
                                        {0, 20 * std::cos(angle), 20 * std::sin(angle)}, 20, 10));
  const auto surface = surface_of(testing::together(sheets));
  const auto on_sheet = [](double angle) {
    return [angle](const Point& p) {
      const double along = p.y() * std::cos(angle) + p.z() * std::sin(angle);
      return 100 - (along > std::hypot(p.y(), p.z()) - 1e-6 ? along : 0);
    };
  };
  const Regions regions =
      regions_of(surface, stretch_of(surface, {on_sheet(0), on_sheet(2), on_sheet(4)}));
  for (const auto& size : regions.sizes) EXPECT_NEAR(size.area_mm2, 800, 1e-6);
  EXPECT_NEAR(regions.seam_mm, 40, 1e-6);
}

TEST(Regions, BadStretchIsRefused) {
  const auto surface = flat_sheet();
  const auto good = stretch_of(surface, {[](const Point&) { return 1.0; }});
  const auto refuses = [&](const Stretch& stretch) {
    const auto regions = make_regions(surface, stretch, {}, {});
    return !regions && regions.error().code == Code::kInvalidArgument;
  };
  EXPECT_TRUE(refuses({}));
  EXPECT_TRUE(refuses(Stretch(13, good[0])));
  EXPECT_TRUE(refuses({std::vector<double>(3, 1.0)}));
  auto bad = good;
  bad[0][5] = std::nan("");
  EXPECT_TRUE(refuses(bad));
  bad[0][5] = -1;
  EXPECT_TRUE(refuses(bad));
  EXPECT_FALSE(make_regions(surface, good, {std::nan("")}, {}));
}

}  // namespace
}  // namespace hydroprint::plan
