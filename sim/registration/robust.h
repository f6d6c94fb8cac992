#pragma once

#include <vector>

namespace hydroprint::registration {

/// Estimates the ratio of the residuals' spread to their noise from the median of their absolute
/// values; at least 1.
/// @param sigmas_off  residuals in units of their noise
[[nodiscard]] double spread_of(std::vector<double> sigmas_off);

/// Returns Tukey's biweight, in [0, 1], of a residual in units of its noise. It is 95 % efficient
/// for normal errors (Huber, Robust Statistics, 1981).
[[nodiscard]] double robust_weight(double sigmas_off, double spread);

}  // namespace hydroprint::registration
