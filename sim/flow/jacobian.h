#pragma once

#include <Eigen/Core>
#include <array>

namespace hydroprint::flow {

/// Singular values of the affine map from a triangle of the film to a triangle of the surface
/// (eq. 6): how far the film is stretched, one at rest.
struct Stretch {
  double most = 0, least = 0;
};

/// @param film_mm, surface_mm  the same three corners on both
/// @return both values infinite if the film triangle has no area
[[nodiscard]] Stretch stretch_of(const std::array<Eigen::Vector2d, 3>& film_mm,
                                 const std::array<Eigen::Vector3d, 3>& surface_mm);

}  // namespace hydroprint::flow
