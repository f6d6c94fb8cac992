#include "sim/scan/fusion.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "sim/base/check.h"
#include "sim/scan/check_frames.h"

namespace hydroprint::scan {
namespace {

/// The image counts as black if a smaller fraction of its pixels has a depth.
constexpr double kDarkShare = 0.02;
/// Maximum fraction of pixels whose depth varies beyond the noise, as it does at edges.
constexpr double kUnsteadyShare = 0.05;
constexpr double kUnsteadySigmas = 2.5;
constexpr double kOutlierSigmas = 4;
constexpr double kMadToSigma = 1.4826;
/// Minimum number of frames from which a standard deviation is estimated.
constexpr std::size_t kFewFrames = 5;

struct Pixel {
  double mean_mm = 0;
  double sigma_mm = 0;  ///< standard error of the mean
  std::size_t frames = 0;
  bool unsteady = false;
};

double deviation(const std::vector<double>& values, double from) {
  double sum = 0;
  for (const double x : values) sum += (x - from) * (x - from);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double median(std::vector<double>& values) {
  HP_CHECK(!values.empty());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// @param values  depths of a pixel, all above 0; they are reordered, and outliers are removed
Pixel mean_of(std::vector<double>& values, std::vector<double>& scratch, const DepthNoise& noise) {
  HP_CHECK(!values.empty());
  Pixel out;
  const std::size_t all = values.size();
  const double middle = median(values);
  const double expected = noise.changing_sigma_mm(middle);
  out.unsteady = deviation(values, middle) > kUnsteadySigmas * noise.sigma_mm(middle);
  scratch.clear();
  for (const double x : values) scratch.push_back(std::abs(x - middle));
  const double gate = kOutlierSigmas * std::max(expected, kMadToSigma * median(scratch));
  std::erase_if(values, [&](double x) { return std::abs(x - middle) > gate; });
  double sum = 0;
  for (const double x : values) sum += x;
  out.frames = values.size();
  const auto count = static_cast<double>(out.frames);
  out.mean_mm = sum / count;
  const bool tells = all >= kFewFrames;
  const double one = tells ? std::max(deviation(values, out.mean_mm), expected / 2) : expected;
  out.sigma_mm = one / std::sqrt(count);
  return out;
}

Pixel fuse_pixel(std::span<const DepthFrame> frames, std::size_t i, std::vector<double>& values,
                 std::vector<double>& scratch, const DepthNoise& noise,
                 const std::optional<DepthSteps>& steps) {
  values.clear();
  for (const DepthFrame& frame : frames) {
    const float depth = frame.depth_mm[i];
    if (depth > 0 && std::isfinite(depth))
      values.push_back(steps ? steps->before_rounding_mm(depth) : depth);
  }
  if (values.empty() || 2 * values.size() < frames.size()) return {};
  return mean_of(values, scratch, noise);
}

Status judge(std::size_t pixels, std::size_t valid, std::size_t unsteady) {
  if (static_cast<double>(valid) < kDarkShare * static_cast<double>(pixels))
    return fail(Code::kFailedPrecondition,
                "the camera sees nothing. Uncover it, or move it to a distance of 0.6 to 1.2 m",
                ErrorReason::CAMERA_BLACK);
  if (static_cast<double>(unsteady) > kUnsteadyShare * static_cast<double>(valid))
    return fail(Code::kFailedPrecondition,
                "the camera or the scene moved between frames. Keep both still and scan again",
                ErrorReason::CAMERA_MOVED);
  return {};
}

}  // namespace

Result<FusedFrame> fuse(std::span<const DepthFrame> frames, const DepthNoise& noise,
                        const Context& context) {
  return fuse(frames, noise, find_depth_steps(frames), context);
}

Result<FusedFrame> fuse(std::span<const DepthFrame> frames, const DepthNoise& noise,
                        const std::optional<DepthSteps>& steps, const Context& context) {
  HP_RETURN_IF_ERROR(check_frames(frames));
  const int width = frames.front().width_px;
  const int height = frames.front().height_px;
  const std::size_t pixels = frames.front().depth_mm.size();
  FusedFrame out{{width, height, std::vector<float>(pixels)},
                 std::vector<float>(pixels),
                 std::vector<std::uint16_t>(pixels)};
  std::vector<std::size_t> valid(static_cast<std::size_t>(height)), unsteady = valid;
  const auto fuse_row = [&](std::size_t v) -> Status {
    std::vector<double> values, scratch;
    for (int u = 0; u < width; ++u) {
      const std::size_t i = out.mean.index(u, static_cast<int>(v));
      const Pixel pixel = fuse_pixel(frames, i, values, scratch, noise, steps);
      out.mean.depth_mm[i] = static_cast<float>(pixel.mean_mm);
      out.sigma_mm[i] = static_cast<float>(pixel.sigma_mm);
      out.frames[i] = static_cast<std::uint16_t>(pixel.frames);
      valid[v] += pixel.frames > 0 ? 1 : 0;
      unsteady[v] += pixel.unsteady ? 1 : 0;
    }
    return {};
  };
  HP_RETURN_IF_ERROR(parallel_for(context, "fusing", static_cast<std::size_t>(height), fuse_row));
  std::size_t all_valid = 0, all_unsteady = 0;
  for (const std::size_t n : valid) all_valid += n;
  for (const std::size_t n : unsteady) all_unsteady += n;
  HP_RETURN_IF_ERROR(judge(pixels, all_valid, all_unsteady));
  return out;
}

}  // namespace hydroprint::scan
