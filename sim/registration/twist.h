#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "sim/base/pose.h"

namespace hydroprint::registration {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
/// Derivative of a motion with respect to the camera's unknowns (scan::CameraErrors), one column
/// for each.
using CameraGain = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Returns a small motion: rotation about `centre` (radians), then translation (mm).
[[nodiscard]] inline Pose motion(const Vector6& twist, const Eigen::Vector3d& centre) {
  const double angle = twist.head<3>().norm();
  Pose out = Pose::Identity();
  if (angle > 0) out.linear() = Eigen::AngleAxisd(angle, twist.head<3>() / angle).matrix();
  out.translation() = centre - out.linear() * centre + twist.tail<3>();
  return out;
}

/// Returns the twist about `centre` that transforms `from` to `to`.
[[nodiscard]] inline Vector6 twist_between(const Pose& from, const Pose& to,
                                           const Eigen::Vector3d& centre) {
  const Pose step = to * from.inverse();
  const Eigen::AngleAxisd turn(step.linear());
  Vector6 out;
  out << turn.angle() * turn.axis(), step * centre - centre;
  return out;
}

[[nodiscard]] inline Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a) {
  Eigen::Matrix3d out;
  out << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return out;
}

/// Returns the matrix that converts twists about the centre `from` to twists about the centre `to`.
[[nodiscard]] inline Matrix6 recentred(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  Matrix6 out = Matrix6::Identity();
  out.bottomLeftCorner<3, 3>() = -cross_matrix(to - from);
  return out;
}

/// Returns the matrix that rotates the coordinates of twists.
[[nodiscard]] inline Matrix6 turned(const Eigen::Matrix3d& turn) {
  Matrix6 out = Matrix6::Zero();
  out.topLeftCorner<3, 3>() = turn;
  out.bottomRightCorner<3, 3>() = turn;
  return out;
}

}  // namespace hydroprint::registration
