// The known part of a camera's constant noise is subtracted from its depths.
#include "sim/scan/fixed_pattern.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "sim/scan/camera_errors.h"

namespace hydroprint::scan {
namespace {

constexpr int kPatternWidth = 64, kPatternHeight = 48, kPatternPatch = 4;
constexpr double kWall_mm = 800;
constexpr double kLeftOver = 0.2;

Lens lens_of_64() {
  Lens out;
  out.width_px = kPatternWidth;
  out.height_px = kPatternHeight;
  out.cx_px = kPatternWidth / 2.0;
  out.cy_px = kPatternHeight / 2.0;
  out.depth_scale = 1.01;
  return out;
}

/// A pattern of waves over the image. The last unknown is common to all offsets.
FixedPattern wavy_pattern() {
  FixedPattern out{kPatternWidth, kPatternHeight, kPatternPatch};
  for (std::size_t i = 0; i < out.patches(); ++i)
    out.offset.push_back(static_cast<float>(1.5 * std::sin(0.7 * static_cast<double>(i))));
  out.sigma.assign(out.patches(), static_cast<float>(kLeftOver));
  Eigen::MatrixXd shared = Eigen::MatrixXd::Zero(Lens::kParameters + 1, 192);
  shared.bottomRows<1>().setConstant(0.1);
  out.set_shared(shared);
  return out;
}

/// The frame of a camera with this pattern that looks straight at a wall.
FusedFrame wall_through(const FixedPattern& pattern) {
  FusedFrame out{
      {kPatternWidth, kPatternHeight, std::vector<float>(kPatternWidth * kPatternHeight)},
      std::vector<float>(kPatternWidth * kPatternHeight, 0.1F),
      {}};
  const double constant_mm = DepthNoise{}.constant_sigma_mm(kWall_mm);
  for (int v = 0; v < kPatternHeight; ++v)
    for (int u = 0; u < kPatternWidth; ++u)
      out.mean.depth_mm[out.mean.index(u, v)] =
          static_cast<float>(kWall_mm + pattern.offset[pattern.patch_at(u, v)] * constant_mm);
  return out;
}

TEST(FixedPattern, KnownOffsetsAreSubtractedAndTheRestRemains) {
  const FixedPattern pattern = wavy_pattern();
  const auto cloud = make_cloud(wall_through(pattern), {lens_of_64(), {}, pattern}, {}, {});
  ASSERT_TRUE(cloud) << cloud.error().message;
  ASSERT_GT(cloud->points.size(), 2000U);
  const double usual_mm = 1.01 * DepthNoise{}.constant_sigma_mm(kWall_mm);
  for (const ScanPoint& p : cloud->points) {
    EXPECT_NEAR(p.reported_mm, kWall_mm, 0.01);
    EXPECT_NEAR(p.point_mm.z(), 1.01 * kWall_mm, 0.01);
    EXPECT_NEAR(p.normal.z(), -1, 1e-3);
    EXPECT_NEAR(p.usual_constant_mm, usual_mm, 1e-3);
    EXPECT_NEAR(p.constant_sigma_mm, kLeftOver * usual_mm, 1e-3);
  }
}

TEST(FixedPattern, WithoutAPatternDepthsStayUnchanged) {
  const FusedFrame fused = wall_through(wavy_pattern());
  const auto cloud = make_cloud(fused, {lens_of_64()}, {}, {});
  ASSERT_TRUE(cloud) << cloud.error().message;
  ASSERT_FALSE(cloud->points.empty());
  for (const ScanPoint& p : cloud->points) {
    EXPECT_NEAR(p.reported_mm, fused.mean.depth_mm[fused.mean.index(p.u, p.v)], 1e-9);
    EXPECT_EQ(p.constant_sigma_mm, p.usual_constant_mm);
  }
}

TEST(FixedPattern, OfAnotherImageOrSquareSizeIsRefused) {
  FixedPattern other = wavy_pattern();
  other.height_px = 2 * kPatternHeight;
  const FusedFrame fused = wall_through(wavy_pattern());
  const auto refused = make_cloud(fused, {lens_of_64(), {}, other}, {}, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::kInvalidArgument);
  EXPECT_NE(refused.error().message.find("64 x 96 pixels in squares of 4 pixels"),
            std::string::npos)
      << refused.error().message;
  DepthNoise noise;
  noise.patch_px = 8;
  EXPECT_FALSE(make_cloud(fused, {lens_of_64(), {}, wavy_pattern()}, noise, {}));
}

TEST(FixedPattern, SharedErrorsAreStoredToWithinAStep) {
  Eigen::MatrixXd shared = Eigen::MatrixXd::Random(12, 192);
  shared.row(3).setZero();
  FixedPattern pattern = wavy_pattern();
  pattern.set_shared(shared);
  const Eigen::MatrixXd kept =
      pattern.step.cast<double>().asDiagonal() * pattern.shared.cast<double>();
  EXPECT_LT((kept - shared).cwiseAbs().maxCoeff(), 0.51 / 127);
}

/// Compares the derivatives of a point's position by the camera's unknowns with differences.
TEST(CameraErrors, AreTheDerivativesOfAPointByLensAndPattern) {
  Camera camera{lens_of_64(), {}, wavy_pattern()};
  const Lens::Matrix mixed = Lens::Matrix::Random();
  const Lens::Vector sizes = (Lens::Vector() << 2, 2, 3, 3, 0.1, 0.1, 0.01, 0.01, 0.01).finished();
  camera.covariance = sizes.asDiagonal() * (mixed * mixed.transpose()) * sizes.asDiagonal();
  const FusedFrame fused = wall_through(camera.pattern);
  const auto cloud = make_cloud(fused, camera, {}, {});
  ASSERT_TRUE(cloud) << cloud.error().message;
  const CameraErrors errors(camera);
  ASSERT_EQ(errors.count(), Lens::kParameters + 1);
  const Lens::Matrix root = camera.covariance.llt().matrixL();
  const Eigen::Vector3d along(0.3, -0.5, 0.8);
  const ScanPoint& p = *cloud->at(50, 11);
  for (Eigen::Index k = 0; k < errors.count(); ++k) {
    const double small = 1e-3;
    Camera other = camera;
    if (k < Lens::kParameters)
      other.lens = camera.lens.with(camera.lens.parameters() + small * root.col(k));
    else
      for (float& x : other.pattern.offset) x += static_cast<float>(0.1 * small * 100);
    const auto moved = make_cloud(fused, other, {}, {});
    ASSERT_TRUE(moved);
    const double by =
        along.dot(moved->at(50, 11)->point_mm - p.point_mm) / (k < Lens::kParameters ? 1 : 100);
    EXPECT_NEAR(errors.along(along, p)[k], by / small, 0.02 * std::abs(by / small) + 1e-3) << k;
  }
}

}  // namespace
}  // namespace hydroprint::scan
