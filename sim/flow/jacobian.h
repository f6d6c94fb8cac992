#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace hydroprint::flow {

/// Derivative of the map from the surface to the film (the inverse of eq. 6): displacement on the
/// film per displacement along the surface.
using Gradient = Eigen::Matrix<double, 2, 3>;

/// Singular values of the Jacobian of the map from film to surface (section 6); 1 at rest.
struct Stretch {
  double most = 0, least = 0;
};

/// Returns the stretch of the film where the inverse map has this gradient; infinite where the film
/// is stretched without limit.
[[nodiscard]] Stretch stretch_of(const Gradient& gradient);

/// Returns the gradient on one triangle, where it is constant.
/// @return zero if the surface triangle has no area
[[nodiscard]] Gradient gradient_of(const std::array<Eigen::Vector2d, 3>& film_mm,
                                   const std::array<Eigen::Vector3d, 3>& surface_mm);

/// Computes the gradient at each point: the area-weighted mean over the triangles around it. The
/// mean of the inverse map's gradients stays finite where the film is stretched without limit.
/// @param film_mm  for each point. Triangles with a NaN corner, with the film upside down, or
///                 across a jump of the map are ignored
/// @return NaN at points without a triangle
[[nodiscard]] std::vector<Gradient> point_gradients(const std::vector<Eigen::Vector2d>& film_mm,
                                                    const std::vector<Eigen::Vector3d>& surface_mm,
                                                    const std::vector<Eigen::Vector3i>& triangles);

/// Computes the stretch at each point as section 6 of the paper defines it: the singular values on
/// each triangle, where the Jacobian is constant (eq. 6), and then their mean over the triangles
/// around the point.
/// @param film_mm  the film's points at the corners of each triangle. The triangles that
///                 point_gradients() ignores are ignored
/// @return infinite at points without a triangle
[[nodiscard]] std::vector<Stretch> point_stretch(
    const std::vector<std::array<Eigen::Vector2d, 3>>& film_mm,
    const std::vector<Eigen::Vector3d>& surface_mm, const std::vector<Eigen::Vector3i>& triangles);

}  // namespace hydroprint::flow
