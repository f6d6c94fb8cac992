#pragma once

#include <cmath>

#include "sim/base/pose.h"

namespace hydroprint {

/// Returns a camera's pose X_FC, which transforms camera coordinates (x to the right of the image,
/// y down, z forward along the optical axis, mm) to F. The near side of the film is at the bottom
/// of the image. For a camera that looks along y, the water is at the bottom.
/// @param eye_mm     position of the camera
/// @param target_mm  the point at which it looks; must differ from `eye_mm`
/// @param turn_rad   rotation about the optical axis
[[nodiscard]] inline Pose look_at(const Eigen::Vector3d& eye_mm, const Eigen::Vector3d& target_mm,
                                  double turn_rad) {
  const Eigen::Vector3d forward = (target_mm - eye_mm).normalized();
  const bool is_level = std::abs(forward.y()) > 0.99;
  const Eigen::Vector3d guess = is_level ? Eigen::Vector3d(0, 0, -1) : Eigen::Vector3d(0, -1, 0);
  const Eigen::Vector3d down = (guess - guess.dot(forward) * forward).normalized();
  Pose out = Pose::Identity();
  out.linear() << down.cross(forward), down, forward;
  out.rotate(Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ()));
  out.translation() = eye_mm;
  return out;
}

}  // namespace hydroprint
