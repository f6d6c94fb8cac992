#include "hardware/simulator/camera/sensor.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hydroprint::simulated_camera {
namespace {

/// A pixel whose depth differs from a neighbour's by more than this fraction is at an edge. The
/// correlation window (9 x 9 pixels, Konolige and Mihelich 2011) sees two surfaces there, and about
/// half of the pixels have no measurement.
constexpr float kEdgeJump = 0.02F;
constexpr std::uint64_t kMissing =
    0x80000000U;  ///< probability of a missing pixel at an edge, in units of 2^-32

/// Mixes the bits of a word (the finaliser of Steele, Lea and Flood's SplitMix, 2014).
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

constexpr std::size_t kQuantiles = 1U << 14U;

/// Quantiles of the standard normal distribution, at the midpoints of equal probability intervals.
std::array<float, kQuantiles> normal_quantiles() {
  std::array<float, kQuantiles> out{};
  double low = -6;
  double squares = 0;
  for (std::size_t i = 0; i < kQuantiles / 2; ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(kQuantiles);
    double high = 0;
    double from = low;
    for (int k = 0; k < 50; ++k) {
      const double middle = (from + high) / 2;
      (0.5 * std::erfc(-middle / std::sqrt(2.0)) < share ? from : high) = middle;
    }
    low = from;
    squares += 2 * from * from;
    out[i] = static_cast<float>(from);
  }
  const auto scale = static_cast<float>(std::sqrt(static_cast<double>(kQuantiles) / squares));
  for (std::size_t i = 0; i < kQuantiles / 2; ++i) {
    out[i] *= scale;
    out[kQuantiles - 1 - i] = -out[i];
  }
  return out;
}

float normal(std::uint64_t word) {
  static const auto quantiles = normal_quantiles();
  return quantiles[word % kQuantiles];
}

bool is_edge(const Depths& depths, int x, int y) {
  const auto at = [&](int dx, int dy) { return depths[(y + dy) * kWidth_px + (x + dx)]; };
  const float here = at(0, 0);
  const auto jumps = [&](int dx, int dy) { return std::abs(at(dx, dy) - here) > kEdgeJump * here; };
  return (x > 0 && jumps(-1, 0)) || (x + 1 < kWidth_px && jumps(1, 0)) || (y > 0 && jumps(0, -1)) ||
         (y + 1 < kHeight_px && jumps(0, 1));
}

double in_steps(double depth_mm) {
  constexpr double kPerStep = kFocal_px * kBaseline_mm / kDisparityStep_px;
  return kPerStep / std::round(kPerStep / depth_mm);
}

std::uint16_t sensor_value(double depth_mm) {
  const double whole = std::round(depth_mm);
  return whole < kLeast_mm || whole > kMost_mm ? 0 : static_cast<std::uint16_t>(whole);
}

}  // namespace

double noise_sigma_mm(double depth_mm) {
  const double beyond_m = depth_mm / 1000 - 0.4;
  return 1.2 + 1.9 * beyond_m * beyond_m;
}

std::vector<float> constant_noise(std::uint64_t seed) {
  constexpr int kAcross = (kWidth_px + kPatch_px - 1) / kPatch_px;
  constexpr int kDown = (kHeight_px + kPatch_px - 1) / kPatch_px;
  std::vector<float> out(static_cast<std::size_t>(kAcross) * kDown);
  const std::uint64_t key = mixed(seed ^ 0x7061746368U);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = normal(mixed(key + i));
  return out;
}

Frame sense(const Depths& depths, double depth_scale, const Errors& errors, std::uint64_t seed,
            int number) {
  constexpr int kAcross = (kWidth_px + kPatch_px - 1) / kPatch_px;
  const std::uint64_t key = mixed(mixed(seed) + static_cast<std::uint64_t>(number));
  const std::vector<float> constant = errors.noise ? constant_noise(seed) : std::vector<float>();
  const double share = std::sqrt(kConstantShare);
  const double rest = std::sqrt(1 - kConstantShare);
  Frame out(depths.size(), 0);
  for (int y = 0; y < kHeight_px; ++y) {
    for (int x = 0; x < kWidth_px; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * kWidth_px + x;
      if (!(depths[i] > 0)) continue;
      const std::uint64_t word = mixed(key + i);
      if (errors.gaps && word >> 32U < kMissing && is_edge(depths, x, y)) continue;
      double depth_mm = depth_scale * depths[i];
      if (errors.noise) {
        const std::size_t patch = static_cast<std::size_t>(y / kPatch_px) * kAcross + x / kPatch_px;
        depth_mm += noise_sigma_mm(depths[i]) * (share * constant[patch] + rest * normal(word));
      }
      out[i] = sensor_value(errors.steps ? in_steps(depth_mm) : depth_mm);
    }
  }
  return out;
}

}  // namespace hydroprint::simulated_camera
