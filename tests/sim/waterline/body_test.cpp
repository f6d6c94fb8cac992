#include "sim/waterline/body.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/sim/support/bodies.h"

namespace hydroprint::waterline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
constexpr double kDegree = std::numbers::pi / 180;

/// Outward normal of a surface with contact angle `theta`, facing `azimuth`.
Vector3d normal_at(double theta_rad, double azimuth_rad) {
  return {std::sin(theta_rad) * std::cos(azimuth_rad), std::sin(theta_rad) * std::sin(azimuth_rad),
          -std::cos(theta_rad)};
}

TEST(Pull, PointsToTheObjectWithTheTangentOfHalfTheta) {
  for (const double degrees : {1e-4, 0.1, 5.0, 45.0, 90.0, 120.0, 160.0, 169.9}) {
    for (const double azimuth : {0.0, 0.7, 3.0, -2.0}) {
      const double theta = degrees * kDegree;
      const Vector2d towards = -Vector2d(std::cos(azimuth), std::sin(azimuth));
      const Vector2d got = pull(normal_at(theta, azimuth));
      const double expected = std::tan(theta / 2);
      EXPECT_LT((got - expected * towards).norm(), 1e-8 * expected + 1e-15) << degrees;
    }
  }
}

TEST(Pull, IsClampedAt170Degrees) {
  const double most = std::tan(85 * kDegree);
  for (const double degrees : {170.0, 171.0, 175.0, 179.0, 179.999}) {
    EXPECT_NEAR(pull(normal_at(degrees * kDegree, 1)).norm(), most, 1e-9) << degrees;
  }
}

TEST(Pull, OfLevelFacesIsZeroAndNeverNaN) {
  EXPECT_EQ(pull({0, 0, -1}), Vector2d(0, 0));
  EXPECT_EQ(pull({0, 0, 1}), Vector2d(0, 0));
  for (const double tiny : {1e-300, 1e-100, 1e-15, 1e-13, 1e-11}) {
    EXPECT_TRUE(pull({tiny, 0, 1}).allFinite());
    EXPECT_TRUE(pull({tiny, 0, -1}).allFinite());
  }
}

TEST(Place, PutsTheLowestPointOnTheWaterForAnyZOfThePose) {
  const mesh::Surface surface = testing::surface_of(testing::box({1, 2, 7}, {4, 6, 12}));
  for (const double z : {0.0, 55.0, -1e4}) {
    Pose X_FO = Pose::Identity();
    X_FO.translation() = Vector3d(10, -20, z);
    const Body body = place(surface, X_FO);
    EXPECT_NEAR(body.height_mm, 5, 1e-12);
    EXPECT_NEAR(X_FO.translation().z(), -7, 1e-12);
    double lowest = 1e9;
    for (const Vector3d& p : body.points_mm) lowest = std::min(lowest, p.z());
    EXPECT_EQ(lowest, 0);
    for (std::size_t v = 0; v < body.points_mm.size(); ++v) {
      EXPECT_LT((X_FO * surface.points[v] - body.points_mm[v]).norm(), 1e-11);
    }
  }
}

TEST(Place, TurnsPointsAndNormalsTogether) {
  const mesh::Surface surface = testing::surface_of(testing::box({-1, -2, -3}, {1, 2, 3}));
  Pose X_FO = Pose::Identity();
  X_FO.linear() = Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitX()).toRotationMatrix();
  const Body body = place(surface, X_FO);
  EXPECT_NEAR(body.height_mm, 4, 1e-12);
  for (std::size_t t = 0; t < body.triangles.size(); ++t) {
    const Eigen::Vector3i& v = body.triangles[t];
    const Vector3d face = (body.points_mm[v[1]] - body.points_mm[v[0]])
                              .cross(body.points_mm[v[2]] - body.points_mm[v[0]])
                              .normalized();
    for (const Vector3d& n : body.corner_normals[t]) EXPECT_LT((n - face).norm(), 1e-9);
  }
}

TEST(Place, IgnoresUnusedPoints) {
  mesh::Model model = testing::box({0, 0, 0}, {2, 2, 2});
  model.vertices.emplace_back(50, 50, -100);
  Pose X_FO = Pose::Identity();
  const mesh::Surface surface = testing::surface_of(model);
  EXPECT_NEAR(place(surface, X_FO).height_mm, 2, 1e-12);
  EXPECT_NEAR(centred_pose(surface).translation().x(), -1, 1e-12);
}

TEST(CentredPose, CentresTheBoundingBoxWithoutRotation) {
  const Pose X_FO = centred_pose(testing::surface_of(testing::box({10, 20, 30}, {14, 30, 60})));
  EXPECT_NEAR(X_FO.translation().x(), -12, 1e-12);
  EXPECT_NEAR(X_FO.translation().y(), -25, 1e-12);
  EXPECT_TRUE(X_FO.linear().isIdentity(1e-15));
}

}  // namespace
}  // namespace hydroprint::waterline
