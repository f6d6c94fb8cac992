#pragma once

#include <Eigen/Core>
#include <vector>

namespace hydroprint::print {

/// Distance of a point from a simple polygon; 0 inside.
[[nodiscard]] double distance_to_polygon(const std::vector<Eigen::Vector2d>& polygon,
                                         const Eigen::Vector2d& p);

}  // namespace hydroprint::print
