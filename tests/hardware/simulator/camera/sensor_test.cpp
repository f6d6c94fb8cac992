// Measures the errors of the sensor on planes and compares them with the formulas.
#include "hardware/simulator/camera/sensor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace hydroprint::simulated_camera {
namespace {

constexpr std::size_t kPixels = static_cast<std::size_t>(kWidth_px) * kHeight_px;
/// Variance of rounding to whole millimetres, in mm^2.
constexpr double kRoundingVariance = 1.0 / 12;

Depths plane(double depth_mm) { return Depths(kPixels, static_cast<float>(depth_mm)); }

/// Mean and unbiased variance over time, for every pixel.
struct OverTime {
  std::vector<double> mean, variance;
};

OverTime watch(double depth_mm, const Errors& errors, int frames) {
  OverTime out{std::vector<double>(kPixels), std::vector<double>(kPixels)};
  for (int k = 0; k < frames; ++k) {
    const Frame frame = sense(plane(depth_mm), 1, errors, 7, k);
    for (std::size_t i = 0; i < kPixels; ++i) {
      const double off = frame[i] - depth_mm;
      out.mean[i] += off / frames;
      out.variance[i] += off * off / (frames - 1);
    }
  }
  for (std::size_t i = 0; i < kPixels; ++i) {
    out.variance[i] -= out.mean[i] * out.mean[i] * frames / (frames - 1);
  }
  return out;
}

double average(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double spread(const std::vector<double>& values) {
  const double mean = average(values);
  double sum = 0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return sum / static_cast<double>(values.size());
}

TEST(Sensor, SigmaMatchesTheFormulaAndHalfTheVarianceIsConstant) {
  constexpr int kFrames = 12;
  for (const double z_mm : {500.0, 800.0, 1500.0, 3000.0}) {
    const double beyond = z_mm / 1000 - 0.4;
    const double variance = std::pow(1.2 + 1.9 * beyond * beyond, 2);
    const OverTime seen = watch(z_mm, {true, false, false}, kFrames);
    const double passing = average(seen.variance);
    const double constant = spread(seen.mean) - passing / kFrames;
    EXPECT_NEAR(passing, variance / 2 + kRoundingVariance, 0.01 * variance) << z_mm;
    // With 19200 patches, the standard deviation of this estimate is 1 %.
    EXPECT_NEAR(constant, variance / 2, 0.04 * variance / 2) << z_mm;
    EXPECT_NEAR(average(seen.mean), 0, 4 * std::sqrt(variance / 2 / 19200)) << z_mm;
  }
}

TEST(Sensor, TheConstantPartIsTheSameOverPatchesOfFourPixels) {
  constexpr int kFrames = 20;
  const double half = std::pow(noise_sigma_mm(800), 2) / 2;
  const OverTime seen = watch(800, {true, false, false}, kFrames);
  std::vector<double> within, across;
  for (int y = 0; y < kHeight_px; ++y) {
    for (int x = 0; x + 1 < kWidth_px; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * kWidth_px + x;
      (x % 4 == 3 ? across : within).push_back(seen.mean[i + 1] - seen.mean[i]);
    }
  }
  const double passing = 2 * (half + kRoundingVariance) / kFrames;
  EXPECT_NEAR(spread(within), passing, 0.03 * passing);
  EXPECT_NEAR(spread(across), passing + 2 * half, 0.05 * 2 * half);
}

TEST(Sensor, DisparityHasStepsOfAnEighthPixel) {
  Depths ramp(kPixels);
  for (std::size_t i = 0; i < kPixels; ++i) {
    ramp[i] = 600 + 0.4F * static_cast<float>(i) / kWidth_px;
  }
  const Frame frame = sense(ramp, 1, {false, true, false}, 1, 0);
  std::set<int> seen(frame.begin(), frame.end());
  for (const int depth_mm : seen) {
    const double steps = 8 * 575.8 * 75 / depth_mm;
    const double nearest = 8 * 575.8 * 75 / std::round(steps);
    EXPECT_LE(std::abs(nearest - depth_mm), 0.5)
        << "depths are a multiple of the step, rounded to whole mm";
  }
  const double all = 8 * 575.8 * 75 * (1 / 600.0 - 1 / 791.7);
  EXPECT_NEAR(static_cast<double>(seen.size()), all, 2);
  for (std::size_t i = 0; i < kPixels; ++i) {
    const double step = ramp[i] * ramp[i] / (8 * 575.8 * 75);
    ASSERT_LE(std::abs(frame[i] - ramp[i]), step / 2 * 1.01 + 0.5);
  }
}

TEST(Sensor, StepsAddTheVarianceOfRounding) {
  const OverTime seen = watch(800, {true, true, false}, 8);
  const double step = 800.0 * 800 / (8 * 575.8 * 75);
  const double expected = std::pow(noise_sigma_mm(800), 2) + step * step / 12 + kRoundingVariance;
  EXPECT_NEAR(average(seen.variance) + spread(seen.mean) - average(seen.variance) / 8, expected,
              0.03 * expected);
}

TEST(Sensor, PixelsAreMissingAtEdgesAndNowhereElse) {
  Depths edge = plane(800);
  for (int y = 0; y < kHeight_px; ++y) {
    for (int x = 300; x < kWidth_px; ++x) edge[static_cast<std::size_t>(y) * kWidth_px + x] = 700;
  }
  int missing = 0;
  const Frame frame = sense(edge, 1, {}, 3, 15);
  for (int y = 0; y < kHeight_px; ++y) {
    for (int x = 0; x < kWidth_px; ++x) {
      if (frame[static_cast<std::size_t>(y) * kWidth_px + x] != 0) continue;
      ASSERT_TRUE(x == 299 || x == 300) << x;
      ++missing;
    }
  }
  EXPECT_NEAR(missing, kHeight_px, 4 * std::sqrt(kHeight_px / 2.0))
      << "half of the pixels of the two columns at the edge";
}

TEST(Sensor, DepthIsScaledAndNotMeasuredOutOfRange) {
  const Errors none{false, false, false};
  EXPECT_EQ(sense(plane(800), 1.01, none, 1, 0)[5], 808);
  EXPECT_EQ(sense(plane(399), 1, none, 1, 0)[5], 0);
  EXPECT_EQ(sense(plane(4001), 1, none, 1, 0)[5], 0);
  EXPECT_EQ(sense(plane(0), 1, {}, 1, 0)[5], 0);
}

TEST(Sensor, TheSameSeedAndTimeGiveTheSameBits) {
  const Frame frame = sense(plane(800), 1, {}, 5, 37);
  EXPECT_EQ(frame, sense(plane(800), 1, {}, 5, 37));
  EXPECT_NE(frame, sense(plane(800), 1, {}, 6, 37));
  EXPECT_NE(frame, sense(plane(800), 1, {}, 5, 38));
}

}  // namespace
}  // namespace hydroprint::simulated_camera
