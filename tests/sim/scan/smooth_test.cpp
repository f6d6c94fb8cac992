// Smoothed frames, compared with the planes and steps in them.
#include "sim/scan/smooth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace hydroprint::scan {
namespace {

constexpr int kWidth_px = 120, kHeight_px = 80;

DepthFrame drawn(const std::function<double(int u, int v)>& depth_mm) {
  DepthFrame out{kWidth_px, kHeight_px, {}};
  for (int v = 0; v < kHeight_px; ++v)
    for (int u = 0; u < kWidth_px; ++u) out.depth_mm.push_back(static_cast<float>(depth_mm(u, v)));
  return out;
}

/// Depth of a plane at 45 degrees, seen by a camera with a focal length of 575.8 px.
double plane_mm(int u, int /*v*/) { return 800 / (1 - (u - kWidth_px / 2.0) / 575.8); }

DepthFrame smoothed(const DepthFrame& frame) {
  Context context;
  context.threads = 2;
  auto out = smooth(frame, {}, context);
  EXPECT_TRUE(out);
  return out ? *out : frame;
}

double rms_mm(const DepthFrame& frame, int margin_px) {
  double squares = 0;
  int count = 0;
  for (int v = margin_px; v < kHeight_px - margin_px; ++v) {
    for (int u = margin_px; u < kWidth_px - margin_px; ++u) {
      squares += std::pow(frame.depth_mm[frame.index(u, v)] - plane_mm(u, v), 2);
      ++count;
    }
  }
  return std::sqrt(squares / count);
}

TEST(Smooth, LeavesAPlaneAndGapsUnchanged) {
  DepthFrame frame = drawn(plane_mm);
  frame.depth_mm[frame.index(50, 40)] = 0;
  const DepthFrame out = smoothed(frame);
  for (std::size_t i = 0; i < frame.depth_mm.size(); ++i)
    EXPECT_NEAR(out.depth_mm[i], frame.depth_mm[i], 0.001);
}

/// The mean of 25 patches has a fifth of their noise.
TEST(Smooth, RemovesTheNoiseOfPatchesInEveryFrame) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0, 1.1);
  std::vector<double> patches(static_cast<std::size_t>(kWidth_px * kHeight_px) / 16);
  for (double& p : patches) p = normal(random);
  const DepthFrame frame = drawn([&](int u, int v) {
    return plane_mm(u, v) + patches[static_cast<std::size_t>(v / 4 * (kWidth_px / 4) + u / 4)];
  });
  EXPECT_NEAR(rms_mm(frame, 8), 1.1, 0.2);
  EXPECT_LT(rms_mm(smoothed(frame), 8), 0.3);
}

TEST(Smooth, LeavesAStepInPlace) {
  const DepthFrame frame = drawn([](int u, int) { return u < 60 ? 800 : 820; });
  const DepthFrame out = smoothed(frame);
  for (std::size_t i = 0; i < frame.depth_mm.size(); ++i)
    EXPECT_NEAR(out.depth_mm[i], frame.depth_mm[i], 0.001);
}

}  // namespace
}  // namespace hydroprint::scan
