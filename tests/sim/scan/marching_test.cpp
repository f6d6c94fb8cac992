#include "sim/scan/marching.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace hydroprint::scan {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr int kCount = 24;
constexpr double kSpacing_mm = 2;

/// The surface of a ball of 17 mm radius, whose middle has no symmetric position in the grid.
TriangleMesh ball() {
  const Vector3d middle(24.3, 23.1, 24.9);
  MarchingTetrahedra marching(Vector3i::Constant(kCount), Vector3d::Zero(), kSpacing_mm);
  for (int i = 0; i < (kCount - 1) * (kCount - 1) * (kCount - 1); ++i) {
    const Vector3i cell(i % (kCount - 1), i / (kCount - 1) % (kCount - 1),
                        i / (kCount - 1) / (kCount - 1));
    std::array<double, 8> values{};
    for (int c = 0; c < 8; ++c) {
      const Vector3d at =
          kSpacing_mm * ((cell + cube_corner(c)).cast<double>() + Vector3d::Constant(0.5));
      values[static_cast<std::size_t>(c)] = (at - middle).norm() - 17;
    }
    marching.add(cell, values);
  }
  return std::move(marching).mesh();
}

TEST(MarchingTetrahedra, BallIsClosedFacesOutwardAndHasItsSize) {
  const TriangleMesh mesh = ball();
  std::map<std::pair<int, int>, int> edges;
  double volume_mm3 = 0;
  for (const Vector3i& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
    const auto p = [&](int i) { return mesh.points_mm[static_cast<std::size_t>(t[i])]; };
    volume_mm3 += p(0).dot(p(1).cross(p(2))) / 6;
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ((edges.count({edge.second, edge.first})), 1U);
  }
  EXPECT_NEAR(volume_mm3 / (4.0 / 3 * std::numbers::pi * 17 * 17 * 17), 1, 0.01);
  EXPECT_EQ(mesh.points_mm.size() + mesh.triangles.size(), edges.size() / 2 + 2) << "Euler";
  for (const Vector3d& p : mesh.points_mm)
    EXPECT_NEAR((p - Vector3d(24.3, 23.1, 24.9)).norm(), 17, 0.1);
}

}  // namespace
}  // namespace hydroprint::scan
