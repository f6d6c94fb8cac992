#pragma once

#include <numbers>

namespace hydroprint::registration {

inline constexpr double kDegree = std::numbers::pi / 180;

/// The 95 % quantile of chi-square with six degrees of freedom, and the 99.9 % quantile with nine.
inline constexpr double kSquare95 = 12.592, kSquare999of9 = 27.877;

}  // namespace hydroprint::registration
