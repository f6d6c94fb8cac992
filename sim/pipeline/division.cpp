#include "sim/pipeline/division.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hydroprint::pipeline {
namespace {

/// Dips whose orientations differ by less, apart from a turn about the vertical, are the same.
constexpr double kSameOrientation_rad = 0.02;
/// Factor on the stretch of a dip whose orientation an earlier one has.
constexpr double kRepeatedStretch = 1e6;

}  // namespace

std::optional<std::size_t> repeated_by(const std::vector<Pose>& X_FO, std::size_t k) {
  const auto down = [&](std::size_t i) -> Eigen::Vector3d {
    return X_FO[i].linear().row(2).transpose();
  };
  for (std::size_t j = 0; j < k; ++j) {
    if (std::acos(std::clamp(down(k).dot(down(j)), -1.0, 1.0)) <= kSameOrientation_rad) return j;
  }
  return std::nullopt;
}

plan::Stretch dividing_stretch(const std::vector<Pose>& X_FO, plan::Stretch stretch) {
  for (std::size_t k = 0; k < stretch.size(); ++k) {
    const double factor = repeated_by(X_FO, k) ? kRepeatedStretch : 1;
    for (double& value : stretch[k])
      value = std::isnan(value) ? std::numeric_limits<double>::infinity() : factor * value;
  }
  return stretch;
}

Result<Division> divide(const mesh::Surface& surface, const plan::Stretch& stretch, double blend_mm,
                        const Context& context) {
  Division out;
  HP_ASSIGN_OR_RETURN(out.regions, plan::make_regions(surface, stretch, {}, context));
  HP_ASSIGN_OR_RETURN(out.weights,
                      plan::BlendWeights::create(surface, out.regions, blend_mm, context));
  return out;
}

}  // namespace hydroprint::pipeline
