// Alignment by PCL from inaccurate start poses.
#include "sim/registration/icp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/registration/shape.h"
#include "tests/support/depth_scene.h"

namespace hydroprint::registration {
namespace {

/// Points of a board's visible face, which determines only three of the six motions.
std::vector<SurfacePoint> seen_face() {
  std::vector<SurfacePoint> out;
  for (int i = -10; i <= 10; ++i)
    for (int k = -10; k <= 10; ++k)
      out.push_back({{5.0 * i, 5.0 * k, 10}, Eigen::Vector3d::UnitZ()});
  return out;
}

TEST(Icp, AlignsAFlatFaceWithItsBody) {
  const auto icp = make_icp(Shape(testing::box({-60, -60, 0}, {60, 60, 10})).samples(3000)).value();
  Pose off(Eigen::Translation3d(2, -1, 6));
  off.rotate(Eigen::AngleAxisd(8 * std::numbers::pi / 180, Eigen::Vector3d(1, 2, 0).normalized()));
  const Aligned found = icp->align(seen_face(), off, 40, 15);
  const Eigen::Vector3d normal = found.pose.linear().col(2);
  EXPECT_LT(std::acos(std::min(1.0, normal.z())), 0.001);
  EXPECT_NEAR((found.pose * Eigen::Vector3d(0, 0, 10)).z(), 10, 0.05);
  // The pose must not drift along directions that the points do not determine.
  EXPECT_LT((found.pose * Eigen::Vector3d(0, 0, 10)).head<2>().norm(), 5);
}

}  // namespace
}  // namespace hydroprint::registration
