#include "sim/scan/fixed_pattern.h"

#include <fmt/format.h>

namespace hydroprint::scan {
namespace {

constexpr float kMostSteps = 127;

}  // namespace

double FixedPattern::taken_off_mm(int u, int v, double reported_mm, const DepthNoise& noise) const {
  if (!is_known()) return reported_mm;
  return reported_mm - offset[patch_at(u, v)] * noise.constant_sigma_mm(reported_mm);
}

Status FixedPattern::check_for(int image_width_px, int image_height_px,
                               const DepthNoise& noise) const {
  if (!is_known() ||
      (width_px == image_width_px && height_px == image_height_px && patch_px == noise.patch_px))
    return {};
  const auto named = [](int width, int height, int patch) {
    return fmt::format("{} x {} pixels in squares of {} pixels", width, height, patch);
  };
  return fail(Code::kInvalidArgument,
              fmt::format("the camera's fixed pattern is for {}, but the frames have {}. Calibrate "
                          "the camera at the resolution of the frames",
                          named(width_px, height_px, patch_px),
                          named(image_width_px, image_height_px, noise.patch_px)));
}

void FixedPattern::set_shared(const Eigen::MatrixXd& derivatives) {
  step = derivatives.cwiseAbs().rowwise().maxCoeff().cast<float>() / kMostSteps;
  shared.resize(derivatives.rows(), derivatives.cols());
  for (Eigen::Index i = 0; i < derivatives.rows(); ++i) {
    const double one = step[i] > 0 ? step[i] : 1;
    shared.row(i) = (derivatives.row(i) / one)
                        .array()
                        .round()
                        .max(-kMostSteps)
                        .min(kMostSteps)
                        .cast<std::int8_t>();
  }
}

}  // namespace hydroprint::scan
