#include "sim/fit/spots.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/mesh/make_surface.h"
#include "sim/sample/icosphere.h"

namespace hydroprint::fit {
namespace {

using Eigen::Vector3d;

Vector3d place(const mesh::Surface& surface, const Spot& spot) {
  Vector3d out = Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    out += spot.barycentric[i] * surface.points[surface.triangles[spot.triangle][i]];
  }
  return out;
}

TEST(Spots, AreNoFartherThanPointsFoundByBruteForce) {
  const mesh::Surface surface =
      mesh::make_surface(sample::icosphere(10, 2), mesh::kMaxEdgeMm, {}).value();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-14, 14), share(0, 1);
  std::vector<Vector3d> points;
  for (int i = 0; i < 60; ++i) {
    points.emplace_back(coordinate(random), coordinate(random), coordinate(random));
  }
  const auto spots = nearest_spots(surface, points, {}).value();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Spot& spot = spots[i];
    EXPECT_NEAR((place(surface, spot) - points[i]).norm(), spot.distance_mm, 1e-9);
    EXPECT_GE(spot.barycentric.minCoeff(), 0);
    EXPECT_NEAR(spot.barycentric.sum(), 1, 1e-12);
    double least = HUGE_VAL;
    for (const Eigen::Vector3i& t : surface.triangles) {
      for (int k = 0; k < 20; ++k) {
        double a = share(random), b = share(random);
        if (a + b > 1) a = 1 - a, b = 1 - b;
        if (k < 3) a = k == 1 ? 1 : 0, b = k == 2 ? 1 : 0;
        const Vector3d p = (1 - a - b) * surface.points[t[0]] + a * surface.points[t[1]] +
                           b * surface.points[t[2]];
        least = std::min(least, (p - points[i]).norm());
      }
    }
    EXPECT_LE(spot.distance_mm, least + 1e-9) << i;
    EXPECT_GE(spot.distance_mm, least - 0.5)
        << "20 samples of each 2 mm wide triangle come this close to the nearest point";
  }
}

TEST(Spots, OfASurfacesOwnPointsAreThosePoints) {
  const mesh::Surface surface =
      mesh::make_surface(sample::icosphere(10, 3), mesh::kMaxEdgeMm, {}).value();
  const auto spots = nearest_spots(surface, surface.points, {}).value();
  for (std::size_t i = 0; i < spots.size(); ++i) {
    EXPECT_LT((place(surface, spots[i]) - surface.points[i]).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace hydroprint::fit
