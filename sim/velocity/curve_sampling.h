#pragma once

#include <Eigen/Core>
#include <vector>

namespace hydroprint::velocity {

/// Samples a closed curve with chords of at most `spacing_mm` that deviate at most `tolerance_mm`
/// from the curve. Points closer together than `least_mm` are merged, even if that exceeds the
/// tolerance. The samples lie on the curve, in its order.
[[nodiscard]] std::vector<Eigen::Vector2d> sample_loop(const std::vector<Eigen::Vector2d>& curve,
                                                       double spacing_mm, double tolerance_mm,
                                                       double least_mm);

}  // namespace hydroprint::velocity
