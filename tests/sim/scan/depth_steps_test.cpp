// The depth steps of a structured-light camera, found from its frames.
#include "sim/scan/depth_steps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "sim/scan/fusion.h"

namespace hydroprint::scan {
namespace {

constexpr int kAcross = 200, kDown = 100;
constexpr double kScale_mm = 352000, kShift = 0.3;

double stepped(double depth_mm) {
  return kScale_mm / (std::round(kScale_mm / depth_mm - kShift) + kShift);
}

/// A surface that slopes across the image from one depth to another, with noise and depth steps, in
/// whole mm.
DepthFrame slope(double from_mm, double to_mm, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, DepthNoise{}.changing_sigma_mm(from_mm));
  DepthFrame out{kAcross, kDown, {}};
  for (int v = 0; v < kDown; ++v)
    for (int u = 0; u < kAcross; ++u)
      out.depth_mm.push_back(static_cast<float>(
          std::round(stepped(from_mm + (to_mm - from_mm) * u / kAcross + noise(random)))));
  return out;
}

TEST(DepthSteps, AreFoundAndTheirRoundingIsCorrected) {
  const std::vector frames{slope(700, 950, 1)};
  const auto steps = find_depth_steps(frames);
  ASSERT_TRUE(steps);
  EXPECT_NEAR(steps->scale_mm / kScale_mm, 1, 2e-4);
  for (const float told : frames[0].depth_mm)
    EXPECT_NEAR(steps->before_rounding_mm(told), stepped(told), 0.05);
}

TEST(DepthSteps, AreNotFoundInSmoothDepths) {
  DepthFrame smooth{kAcross, kDown, {}}, whole = smooth;
  for (int i = 0; i < kAcross * kDown; ++i) {
    smooth.depth_mm.push_back(700 + 0.01F * static_cast<float>(i));
    whole.depth_mm.push_back(static_cast<float>(700 + i % 250));
  }
  EXPECT_FALSE(find_depth_steps(std::vector{smooth}));
  EXPECT_FALSE(find_depth_steps(std::vector{whole}));
  EXPECT_FALSE(find_depth_steps(std::vector{slope(800, 805, 2)}));  // too few steps for a result
  EXPECT_FALSE(find_depth_steps(DepthCounts{}));
}

/// Largest error of the mean of many frames that all pixels of the same depth share.
double shared_error_mm(double from_mm, double to_mm, const std::optional<DepthSteps>& steps) {
  constexpr int kFrames = 30;
  std::vector<DepthFrame> frames;
  for (std::uint32_t k = 0; k < kFrames; ++k) frames.push_back(slope(from_mm, to_mm, k));
  const FusedFrame fused = fuse(frames, {}, steps, {}).value();
  double worst = 0;
  for (int u = 0; u < kAcross; ++u) {
    double mean = 0;
    for (int v = 0; v < kDown; ++v) mean += fused.mean.depth_mm[fused.mean.index(u, v)];
    const double truth = from_mm + (to_mm - from_mm) * u / kAcross;
    worst = std::max(worst, std::abs(mean / kDown - truth));
  }
  return worst;
}

TEST(DepthSteps, LeaveNoErrorThatAllPixelsOfADepthShare) {
  const auto steps = find_depth_steps(std::vector{slope(700, 950, 1)});
  EXPECT_LT(shared_error_mm(700, 950, steps), 0.12);
  EXPECT_GT(shared_error_mm(700, 950, {}), 0.3);
}

/// Frames with only steps of less than 1 mm do not reveal the steps.
TEST(DepthSteps, OfFarFramesHelpNearFrames) {
  const std::vector near{slope(480, 590, 1)}, far{slope(700, 950, 1)};
  EXPECT_FALSE(find_depth_steps(near));
  DepthCounts counts;
  counts.add(near);
  counts.add(far);
  EXPECT_LT(shared_error_mm(480, 590, find_depth_steps(counts)), 0.2);
  EXPECT_GT(shared_error_mm(480, 590, {}), 0.25);
}

}  // namespace
}  // namespace hydroprint::scan
