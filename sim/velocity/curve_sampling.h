#pragma once

#include <Eigen/Core>
#include <vector>

namespace hydroprint::velocity {

/// Picks corners of a closed curve so that the chords between them are at most `spacing_mm` long
/// and stray at most `tolerance_mm` from the curve; corners less than `least_mm` apart are merged
/// first. Points stay on the curve and in its order.
[[nodiscard]] std::vector<Eigen::Vector2d> sample_loop(const std::vector<Eigen::Vector2d>& curve,
                                                       double spacing_mm, double tolerance_mm,
                                                       double least_mm);

}  // namespace hydroprint::velocity
