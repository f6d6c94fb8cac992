#pragma once

#include <numbers>

namespace hydroprint::registration {

inline constexpr double kDegree = std::numbers::pi / 180;

/// Quantiles of chi-square: 95 % with six degrees of freedom, and 99.9 % with nine.
inline constexpr double kSquare95 = 12.592, kSquare999of9 = 27.877;

}  // namespace hydroprint::registration
