#include "sim/scan/fusion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/scan/cloud.h"

namespace hydroprint::scan {
namespace {

constexpr int kWidth = 64, kHeight = 48;
constexpr double kDepth_mm = 800;

DepthFrame flat(float depth_mm) {
  return {kWidth, kHeight, std::vector<float>(kWidth * kHeight, depth_mm)};
}

/// Frames in whole mm with noise that changes from frame to frame.
std::vector<DepthFrame> noisy(int count) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(kDepth_mm, DepthNoise{}.changing_sigma_mm(kDepth_mm));
  std::vector<DepthFrame> out(static_cast<std::size_t>(count), flat(0));
  for (DepthFrame& frame : out)
    for (float& d : frame.depth_mm) d = static_cast<float>(std::round(normal(random)));
  return out;
}

TEST(Fusion, MeanResolvesDepthsBetweenStepsAndStatesItsError) {
  const auto fused = fuse(noisy(60), {}, {});
  ASSERT_TRUE(fused) << fused.error().message;
  double squares = 0, stated = 0;
  for (std::size_t i = 0; i < fused->sigma_mm.size(); ++i) {
    squares += std::pow(fused->mean.depth_mm[i] - kDepth_mm, 2);
    stated += std::pow(fused->sigma_mm[i], 2);
  }
  EXPECT_NEAR(std::sqrt(squares / stated), 1, 0.05);
}

TEST(Fusion, AFewOutliersDoNotChangeTheResult) {
  auto frames = noisy(60);
  for (std::size_t k = 0; k < 10; ++k) frames[k].depth_mm[5] = 1900;
  const auto with = fuse(frames, {}, {});
  ASSERT_TRUE(with);
  EXPECT_NEAR(with->mean.depth_mm[5], kDepth_mm, 1);
  EXPECT_EQ(with->frames[5], 50);
}

TEST(Fusion, APixelMissingInMostFramesStaysMissing) {
  auto frames = noisy(10);
  for (std::size_t k = 0; k < 6; ++k) frames[k].depth_mm[7] = 0;
  for (std::size_t k = 0; k < 5; ++k) frames[k].depth_mm[8] = 0;
  const auto fused = fuse(frames, {}, {});
  ASSERT_TRUE(fused);
  EXPECT_EQ(fused->mean.depth_mm[7], 0);
  EXPECT_GT(fused->mean.depth_mm[8], 0);
}

std::string reason(const std::vector<DepthFrame>& frames) {
  const auto fused = fuse(frames, {}, {});
  return std::string(fused ? "" : name_of(fused.error().reason));
}

TEST(Fusion, RefusesFramesOfAFaultyCamera) {
  EXPECT_EQ(reason({flat(0)}), "CAMERA_BLACK");
  EXPECT_EQ(reason({flat(800), flat(800), flat(800)}), "CAMERA_FROZEN");
  std::vector<DepthFrame> moving;
  for (int k = 0; k < 10; ++k) moving.push_back(flat(800.0F + 3.0F * static_cast<float>(k)));
  EXPECT_EQ(reason(moving), "CAMERA_MOVED");
}

TEST(Fusion, RefusesNoFramesAndFramesOfTwoSizes) {
  EXPECT_FALSE(fuse({}, {}, {}));
  DepthFrame small{kWidth, kHeight / 2, std::vector<float>(kWidth * kHeight / 2, 800)};
  const std::vector<DepthFrame> frames{flat(800), small};
  const auto fused = fuse(frames, {}, {});
  ASSERT_FALSE(fused);
  EXPECT_NE(fused.error().message.find("frame 1"), std::string::npos);
}

TEST(Cloud, PlaneNormalsPointToTheCameraAndEdgesAreLeftOut) {
  Lens lens;
  lens.width_px = kWidth;
  lens.height_px = kHeight;
  lens.cx_px = kWidth / 2.0;
  lens.cy_px = kHeight / 2.0;
  FusedFrame fused{flat(0), std::vector<float>(kWidth * kHeight, 0.1F), {}};
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.4, -1).normalized();
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const double jump = u < kWidth / 2 ? 0 : 100;
      fused.mean.depth_mm[fused.mean.index(u, v)] =
          static_cast<float>((normal.z() * kDepth_mm) / normal.dot(lens.ray(u, v)) + jump);
    }
  }
  const auto cloud = make_cloud(fused, {lens}, {}, {});
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->at(kWidth / 2, 10), nullptr);
  EXPECT_EQ(cloud->at(kWidth / 2 - 1, 10), nullptr);
  const ScanPoint* p = cloud->at(10, 10);
  ASSERT_NE(p, nullptr);
  EXPECT_LT((p->normal - normal).norm(), 1e-4);
  EXPECT_EQ(p->patch, 2 * (kWidth / 4) + 2);
  lens.width_px = 640;
  EXPECT_FALSE(make_cloud(fused, {lens}, {}, {}));
}

}  // namespace
}  // namespace hydroprint::scan
