#include "hardware/simulator/scene/hand.h"

#include <gtest/gtest.h>

namespace hydroprint::simulated_scene {
namespace {

CameraStand swept() {
  CameraStand out;
  out.via_mm = {{-300, -200, 650}, {0, -100, 800}, {300, -200, 650}};
  return out;
}

TEST(Hand, AStandIsStillAndLooksAtItsTargetWithTheFarSideUp) {
  const CameraStand stand;
  const Pose pose = camera_pose(stand, 1, 0);
  EXPECT_TRUE(pose.isApprox(camera_pose(stand, 2, 7.7)));
  EXPECT_TRUE(pose.translation().isApprox(stand.at_mm));
  const Eigen::Vector3d target = pose.inverse() * stand.looks_at_mm;
  EXPECT_NEAR(target.head<2>().norm(), 0, 1e-9);
  EXPECT_NEAR(target.z(), stand.at_mm.norm(), 1e-9);
  EXPECT_LT((pose.inverse() * Eigen::Vector3d(0, 100, 0)).y(), 0)
      << "+y must point up in the image";
  EXPECT_GT((pose.inverse() * Eigen::Vector3d(100, 0, 0)).x(), 0)
      << "+x must point right in the image";
  EXPECT_NEAR(pose.linear().determinant(), 1, 1e-12);
}

TEST(Hand, SweepsThroughItsPositionsAndReturnsAfterThePeriod) {
  CameraStand stand = swept();
  stand.trembles = false;
  for (int i = 0; i < 3; ++i) {
    const Pose pose = camera_pose(stand, 1, stand.period_s * (i + 1) / 4);
    EXPECT_TRUE(pose.translation().isApprox(stand.via_mm[static_cast<std::size_t>(i)], 1e-9));
  }
  EXPECT_TRUE(camera_pose(stand, 1, 3.3).isApprox(camera_pose(stand, 1, 3.3 + stand.period_s)));
}

TEST(Hand, TremblesByMillimetresSmoothlyAndReproducibly) {
  const CameraStand stand = swept();
  CameraStand steady = stand;
  steady.trembles = false;
  double farthest_mm = 0, fastest_mm = 0;
  constexpr double kStep_s = 1e-3;
  for (double t = 0; t < 10; t += 0.01) {
    const Pose pose = camera_pose(stand, 5, t);
    EXPECT_TRUE(pose.isApprox(camera_pose(stand, 5, t)));
    const auto away = [&](double at_s) -> Eigen::Vector3d {
      return camera_pose(stand, 5, at_s).translation() - camera_pose(steady, 5, at_s).translation();
    };
    farthest_mm = std::max(farthest_mm, away(t).norm());
    fastest_mm = std::max(fastest_mm, (away(t + kStep_s) - away(t)).norm() / kStep_s);
  }
  EXPECT_GT(farthest_mm, 1.5);
  EXPECT_LT(farthest_mm, 8);
  EXPECT_LT(fastest_mm, 80) << "the path must have no jumps; speed in mm/s";
  EXPECT_FALSE(camera_pose(stand, 5, 1).isApprox(camera_pose(stand, 6, 1)));
}

}  // namespace
}  // namespace hydroprint::simulated_scene
