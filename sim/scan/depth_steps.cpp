#include "sim/scan/depth_steps.h"

#include <cmath>
#include <cstddef>

namespace hydroprint::scan {
namespace {

/// Focal length in px, baseline in mm, steps per px.
constexpr double kUsualScale_mm = 575.8 * 75 * 8;
constexpr int kScalesAside = 1000, kShifts = 25;
constexpr double kScaleStep = 5e-5, kShiftStep = 1.0 / kShifts;
constexpr double kMostOff = kScalesAside * kScaleStep;
constexpr std::size_t kMost_mm = 10000;
constexpr std::size_t kLeastPixels = 8;   ///< depths of fewer pixels may be outliers
constexpr double kHalf = 0.5 + 1e-4;      ///< maximum rounding error in mm
constexpr double kCoarseSlack_mm = 0.12;  ///< extra error allowed in the coarse search
constexpr double kFinest = 1e-7;
/// Minimum of confidence(): negative logarithm of the probability (1e-11) that wrong steps explain
/// all depths.
constexpr double kLeastConfidence = 25;

struct Steps {
  double scale_mm, shift;

  [[nodiscard]] double nearest_mm(double depth_mm) const {
    return scale_mm / (std::round(scale_mm / depth_mm - shift) + shift);
  }
};

/// Returns the largest distance of a depth from the nearest step. Stops as soon as a distance
/// reaches `enough`.
double worst_mm(const std::vector<double>& depths, const Steps& steps, double enough) {
  double out = 0;
  for (const double depth : depths) {
    out = std::max(out, std::abs(steps.nearest_mm(depth) - depth));
    if (out >= enough) return out;
  }
  return out;
}

/// Returns the depths that occur often, in the range where steps are longer than 1 mm. Empty if not
/// all depths are whole mm.
std::vector<double> often_told(const DepthCounts& counts) {
  std::vector<double> out;
  if (!counts.are_whole) return out;
  const auto first = static_cast<std::size_t>(std::sqrt((1 + kMostOff) * kUsualScale_mm)) + 1;
  for (std::size_t depth = first; depth < counts.of_mm.size(); ++depth)
    if (counts.of_mm[depth] >= kLeastPixels) out.push_back(static_cast<double>(depth));
  return out;
}

double confidence(const std::vector<double>& depths) {
  double out = 0;
  for (const double depth : depths) out += std::log(depth * depth / kUsualScale_mm);
  return out;
}

/// Finds the steps with the smallest worst_mm() by a coarse grid search and repeated refinement
/// around the best.
Steps closest(const std::vector<double>& depths) {
  Steps best{kUsualScale_mm, 0};
  double worst = kHalf + kCoarseSlack_mm;
  const auto look = [&](const Steps& at) {
    const double there = worst_mm(depths, at, worst);
    if (there >= worst) return false;
    worst = there;
    best = at;
    return true;
  };
  for (int i = -kScalesAside; i <= kScalesAside; ++i)
    for (int j = 0; j < kShifts; ++j) look({kUsualScale_mm * (1 + i * kScaleStep), j * kShiftStep});
  for (double scale = kScaleStep, shift = kShiftStep; scale > kFinest;) {
    const Steps around = best;
    bool is_better = false;
    for (int i = -4; i <= 4; ++i)
      for (int j = -4; j <= 4; ++j)
        is_better |= look({around.scale_mm * (1 + i * scale / 2), around.shift + j * shift / 2});
    if (is_better) continue;
    scale /= 2;
    shift /= 2;
  }
  return best;
}

/// Returns the mean of the steps that are rounded to a depth; the depth itself if there are none.
double before_rounding(const Steps& steps, std::size_t whole_mm) {
  const auto depth = static_cast<double>(whole_mm);
  const double first = std::ceil(steps.scale_mm / (depth + kHalf) - steps.shift);
  const double last = steps.scale_mm / (depth - kHalf) - steps.shift;
  const int count = first < last ? static_cast<int>(std::ceil(last - first)) : 0;
  double sum = 0;
  for (int k = 0; k < count; ++k) sum += steps.scale_mm / (first + k + steps.shift);
  return count > 0 ? sum / count : depth;
}

}  // namespace

void DepthCounts::add(std::span<const DepthFrame> frames) {
  of_mm.resize(kMost_mm + 1);
  for (const DepthFrame& frame : frames) {
    for (const float depth : frame.depth_mm) {
      if (!(depth > 0 && depth <= static_cast<float>(kMost_mm))) continue;
      are_whole = are_whole && depth == std::floor(depth);
      ++of_mm[static_cast<std::size_t>(depth)];
    }
  }
}

float DepthSteps::before_rounding_mm(float reported_mm) const {
  const auto whole = static_cast<std::size_t>(reported_mm);
  return whole < before_mm.size() ? before_mm[whole] : reported_mm;
}

std::optional<DepthSteps> find_depth_steps(const DepthCounts& counts) {
  const auto depths = often_told(counts);
  if (confidence(depths) < kLeastConfidence) return {};
  const Steps steps = closest(depths);
  if (worst_mm(depths, steps, INFINITY) > kHalf) return {};
  DepthSteps out{steps.scale_mm, steps.shift - std::floor(steps.shift), {0}};
  for (std::size_t whole = 1; whole <= kMost_mm; ++whole)
    out.before_mm.push_back(static_cast<float>(before_rounding(steps, whole)));
  return out;
}

std::optional<DepthSteps> find_depth_steps(std::span<const DepthFrame> frames) {
  DepthCounts counts;
  counts.add(frames);
  return find_depth_steps(counts);
}

}  // namespace hydroprint::scan
