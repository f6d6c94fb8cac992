#pragma once

#include <Eigen/Core>
#include <vector>

namespace hydroprint::print {

/// How far a place is from a simple polygon; inside of it, 0.
[[nodiscard]] double distance_to_polygon(const std::vector<Eigen::Vector2d>& polygon,
                                         const Eigen::Vector2d& p);

}  // namespace hydroprint::print
