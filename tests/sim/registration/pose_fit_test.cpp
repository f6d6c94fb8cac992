// Poses from points that determine only some of the motions.
#include "sim/registration/pose_fit.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/depth_scene.h"

namespace hydroprint::registration {
namespace {

/// Points in the middle of a plate that is perpendicular to the camera's axis.
std::vector<scan::ScanPoint> points_of_a_plate(double z_mm) {
  std::vector<scan::ScanPoint> out;
  for (int v = -10; v <= 10; ++v) {
    for (int u = -10; u <= 10; ++u) {
      scan::ScanPoint p;
      p.point_mm = {2.0 * u, 2.0 * v, z_mm};
      p.normal = {0, 0, -1};
      p.reported_mm = z_mm;
      p.sigma_mm = p.constant_sigma_mm = 0.2;
      p.u = 320 + u;
      p.v = 240 + v;
      p.patch = 100 * v + u;
      out.push_back(p);
    }
  }
  return out;
}

/// Motions that no point determines must not lead to an unbounded or NaN step, even if the weak
/// directions are not limited.
TEST(PoseFit, MakesNoStepAlongUndeterminedMotions) {
  const Shape plate(testing::box({-60, -60, 0}, {60, 60, 10}));
  const auto points = points_of_a_plate(800);
  // The start is 2 mm too far away. The underside of the plate faces the camera.
  const Pose start(Eigen::Translation3d(3, -2, 802));
  FitOptions options;
  options.weak_sigma_mm = std::numeric_limits<double>::infinity();
  const auto fit = fit_pose(plate, points, {}, start, start, options, testing::two_threads());
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_EQ(fit->weak.size(), 3U);
  EXPECT_LT((fit->X_CB.translation() - Eigen::Vector3d(3, -2, 800)).norm(), 0.01);
  EXPECT_TRUE(fit->covariance.allFinite());
}

/// Points of a plate's face and of one narrow side. A tenth of the camera's constant noise is
/// unknown.
std::vector<scan::ScanPoint> points_of_two_faces(double z_mm) {
  std::vector<scan::ScanPoint> out;
  const auto add = [&](const Eigen::Vector3d& at, const Eigen::Vector3d& normal) {
    scan::ScanPoint p;
    p.point_mm = at;
    p.normal = normal;
    p.reported_mm = at.z();
    p.sigma_mm = 0.05;
    p.constant_sigma_mm = 0.1;
    p.usual_constant_mm = 1;
    p.patch = static_cast<int>(out.size());
    out.push_back(p);
  };
  for (int i = -20; i <= 20; ++i)
    for (int k = -20; k <= 20; ++k) add({-300 + 2.5 * i, 2.5 * k, z_mm}, -Eigen::Vector3d::UnitZ());
  for (int k = -20; k <= 20; ++k)
    for (int i = 2; i <= 8; ++i) add({-240, 2.5 * k, z_mm + i}, Eigen::Vector3d::UnitX());
  return out;
}

/// With a well-known camera, noise hardly ever moves a point far away. Before a fit has converged,
/// however, points are far from the body, and the fit must not drop them as outliers.
TEST(PoseFit, ConvergesOntoANarrowSideForAnyCameraAccuracy) {
  const Shape plate(testing::box({-60, -60, 0}, {60, 60, 10}));
  const auto points = points_of_two_faces(800);
  const Pose truth(Eigen::Translation3d(-300, 0, 800));
  const Pose start = truth * Eigen::Translation3d(-1.2, 0, 0);
  scan::Camera camera;
  camera.pattern = {640, 480, 4};
  camera.pattern.set_shared(
      Eigen::MatrixXd::Zero(scan::Lens::kParameters, static_cast<Eigen::Index>(points.size())));
  const auto fit = fit_pose(plate, points, camera, start, start, {}, testing::two_threads());
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_EQ(fit->weak.size(), 1U);  // the motion along the narrow side
  EXPECT_NEAR(fit->X_CB.translation().x(), -300, 0.1);
}

TEST(PoseFit, RefusesANanStart) {
  const Shape plate(testing::box({-60, -60, 0}, {60, 60, 10}));
  Pose start = Pose::Identity();
  start.translation().x() = std::numeric_limits<double>::quiet_NaN();
  const auto fit = fit_pose(plate, points_of_a_plate(800), {}, start, Pose::Identity(), {},
                            testing::two_threads());
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().reason, ErrorReason::TOO_FEW_POINTS);
}

}  // namespace
}  // namespace hydroprint::registration
