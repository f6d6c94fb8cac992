#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "sim/mesh/make_surface.h"
#include "sim/mesh/read/read_model.h"
#include "sim/plan/blend.h"
#include "sim/sample/icosphere.h"
#include "tests/sim/plan/fields.h"
#include "tests/sim/plan/reference_distance.h"
#include "tests/sim/support/bodies.h"
#include "tests/support/paths.h"

// The distances behind the weights, compared with CGAL's exact algorithm. Where the own dip's film
// does not end, t_k = w_k / w_own, so d_k = (1 - w_k / w_own) H.
namespace hydroprint::plan {
namespace {

using testing::surface_of;

constexpr double kWidth_mm = 5;

/// Compares the distances of up to `count` random points that lie within the band.
void expect_exact(const mesh::Surface& surface, const Stretch& stretch, int count) {
  const auto regions = make_regions(surface, stretch, {}, {}).value();
  const auto weights = BlendWeights::create(surface, regions, kWidth_mm, {}).value();
  int compared = 0;
  double worst_mm = 0;
  for (const auto& point : testing::random_points(surface, 400 * count, 3)) {
    const auto w = weights.at(point.triangle, point.barycentric);
    const auto own = regions.fragments.find(point.triangle, point.barycentric);
    const int own_dip = regions.fragments.all[own].dip;
    for (int dip = 1; dip <= regions.dips; ++dip) {
      const double weight = w[std::size_t(dip - 1)];
      if (dip == own_dip || (weight == 0 && compared % 7 != 6)) continue;
      const double reference =
          testing::reference_distance(surface, regions, dip, point, kWidth_mm + 0.2);
      ++compared;
      if (weight == 0) {
        EXPECT_GT(reference, kWidth_mm - 0.05);
        continue;
      }
      const double distance = (1 - weight / w[std::size_t(own_dip - 1)]) * kWidth_mm;
      worst_mm = std::max(worst_mm, std::abs(distance - reference));
      EXPECT_GT(distance, reference - 0.05) << point.place.transpose();
      // The reference has fewer sources, so it is never shorter.
      EXPECT_LT(distance, reference + 1e-6) << point.place.transpose();
    }
    if (compared >= count) break;
  }
  EXPECT_GE(compared, count);
  ::testing::Test::RecordProperty("worst_mm", std::to_string(worst_mm));
}

TEST(Distance, IsGeodesicOnASphere) {
  const auto surface = surface_of(sample::icosphere(40, 4), 3);
  expect_exact(surface, testing::two_dips(surface, {0.2, 0.1, 1}), 150);
}

TEST(Distance, IsGeodesicAcrossTheEdgesOfACube) {
  const auto surface = surface_of(testing::box({-10, -10, -10}, {10, 10, 10}));
  expect_exact(surface, testing::two_dips(surface, {1, 0.9, 0.4}), 150);
}

TEST(Distance, IsGeodesicOnCoarseTriangles) {
  const auto surface = surface_of(testing::box({-10, -10, -10}, {10, 10, 10}), 30);
  expect_exact(surface, testing::two_dips(surface, {1, 0.9, 0.4}), 150);
}

TEST(Distance, IsGeodesicAroundHoles) {
  mesh::Model model = sample::icosphere(30, 4);
  // Removes all triangles around some vertices, so that no two holes meet in a point.
  std::vector<int> removed;
  for (int v = 0; v < int(model.vertices.size()); ++v) {
    const auto& p = model.vertices[std::size_t(v)];
    const auto is_apart = [&](int other) {
      return (model.vertices[std::size_t(other)] - p).norm() > 9;
    };
    if (std::abs(p.z()) < 7 && std::all_of(removed.begin(), removed.end(), is_apart))
      removed.push_back(v);
  }
  std::erase_if(model.triangles, [&](const Eigen::Vector3i& t) {
    return std::any_of(removed.begin(), removed.end(),
                       [&](int v) { return t[0] == v || t[1] == v || t[2] == v; });
  });
  ASSERT_GT(removed.size(), 10U);
  const auto surface = surface_of(model);
  expect_exact(surface, testing::two_dips(surface, {0.1, 0, 1}), 150);
}

TEST(Distance, IsGeodesicOnARealModel) {
  const std::filesystem::path path = testing::model_path("spot/spot_triangulated.obj");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path;
  const auto model = mesh::read_model(path, 30, {}).value();
  const auto surface = mesh::make_surface(model, 2, {}).value();
  const auto facing = [](Eigen::Vector3d direction) {
    return [direction](const Eigen::Vector3d& p) { return 100 - direction.dot(p); };
  };
  const auto stretch = testing::stretch_of(
      surface, {facing({1, 0.2, 0}), facing({-0.6, 0.8, 0.1}), facing({0, -0.3, -1})});
  expect_exact(surface, stretch, 600);
}

}  // namespace
}  // namespace hydroprint::plan
