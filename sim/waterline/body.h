#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "sim/base/pose.h"
#include "sim/base/result.h"
#include "sim/mesh/surface.h"

namespace hydroprint::waterline {

/// The object in the film frame F at the start of the dip, with its lowest point at z = 0. The z of
/// a point is therefore the immersion at which the water reaches it.
struct Body {
  std::vector<Eigen::Vector3d> points_mm;  ///< one for each point of the surface
  std::vector<Eigen::Vector3i> triangles;  ///< in the surface's order, with welded indices
  std::vector<std::array<Eigen::Vector3d, 3>> corner_normals;  ///< outward, unit, in F
  double height_mm = 0;  ///< immersion at which the whole object is under water
};

/// Transforms the surface into the film frame.
/// @param X_FO  its z is ignored, and replaced so that the lowest point touches the water
[[nodiscard]] Body place(const mesh::Surface& surface, Pose& X_FO);

/// Returns the default pose of an object: not rotated, with its bounding box centred on the film.
[[nodiscard]] Pose centred_pose(const mesh::Surface& surface);

/// Largest angle between surface and water for which eq. (1) is used.
inline constexpr double kThetaLimit_rad = 170.0 * 3.14159265358979323846 / 180.0;

/// Beyond this angle no film arrives: with eq. (1) clamped at kThetaLimit_rad, the film falls
/// behind the receding waterline (tan(85 deg) < -cot(theta)).
inline constexpr double kThetaLost_rad = 175.0 * 3.14159265358979323846 / 180.0;

/// Returns false if the surface recedes faster than the film can follow.
[[nodiscard]] bool film_can_follow(const Eigen::Vector3d& normal);

/// Returns the film velocity at the waterline per unit of dip speed: eq. (1) in half-angle form,
/// tan(theta / 2) towards the object, with theta clamped at kThetaLimit_rad.
/// @param normal  outward unit normal of the object, in F; cos(theta) = -normal.z
/// @return in-plane vector, dimensionless; zero where the surface lies flat on the water
[[nodiscard]] Eigen::Vector2d pull(const Eigen::Vector3d& normal);

}  // namespace hydroprint::waterline
