#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/base/context.h"
#include "sim/registration/shape.h"
#include "sim/registration/twist.h"
#include "sim/scan/cloud.h"

namespace hydroprint::registration {

/// A motion of the body that the scan does not determine; it is taken from the nominal pose.
struct WeakDirection {
  /// Camera frame, about PoseFit::centre_mm. Scaled so that it moves the surface by 1 mm (rms).
  Vector6 twist = Vector6::Zero();
  double sigma_mm = 0;  ///< standard error of the surface along it, from the scan alone
};

/// Pose of a body and its uncertainty.
struct PoseFit {
  Pose X_CB = Pose::Identity();
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();  ///< camera frame; twists are about it
  /// Covariance of the twist (camera frame) between X_CB and the truth. It is due to the depths'
  /// noise and, along weak directions, to the nominal pose's uncertainty. Radians and mm.
  Matrix6 covariance = Matrix6::Zero();
  /// Derivative of that twist by the camera's unknowns, which `covariance` leaves out. They
  /// contribute camera_gain * camera_gain^T to it.
  CameraGain camera_gain = CameraGain::Zero(6, 0);
  std::vector<WeakDirection> weak;
  /// Number of points on the surface within their noise, and their share of all given points. Here
  /// and in rms_sigmas the noise is that of a camera with an unknown fixed pattern.
  std::size_t points = 0;
  double paired_share = 0;
  double rms_mm = 0;      ///< of the distances of these points
  double rms_sigmas = 0;  ///< of the same distances in units of their noise
};

struct FitOptions {
  /// Directions with a larger standard error than this are taken from the nominal pose.
  double weak_sigma_mm = 1;
  double nominal_turn_sigma_rad = 0.1;
  double nominal_shift_sigma_mm = 10;
  double reach_mm = 10;  ///< points farther from the surface at the start are not paired
  int most_iterations = 60;
};

/// Least squares of the distances of scan points from a surface, along its normals. Each point is
/// weighted by its noise and by Tukey's weight. The start must be within a few mm and degrees. Only
/// the last iterations use the camera's fixed pattern to decide which points lie on the surface.
/// The covariance accounts for the part of the noise that a patch of pixels shares.
/// Fails (kFailedPrecondition) if fewer than 30 points lie on the surface.
[[nodiscard]] Result<PoseFit> fit_pose(const Shape& shape, std::span<const scan::ScanPoint> points,
                                       const scan::Camera& camera, const Pose& start_CB,
                                       const Pose& nominal_CB, const FitOptions& options,
                                       const Context& context);

/// Registration error (rms over its distribution, mm) at each point, from a pose's covariance.
/// @param covariance  of a twist in the frame of the points, about `centre_mm`
[[nodiscard]] std::vector<double> error_at(std::span<const Eigen::Vector3d> points_mm,
                                           const Eigen::Vector3d& centre_mm,
                                           const Matrix6& covariance);

/// Returns "turn about the axis through (x, y, z) along (x, y, z)" or "shift along (x, y, z)", in
/// frame A.
[[nodiscard]] std::string describe(const WeakDirection& direction, const Eigen::Vector3d& centre_C,
                                   const Pose& X_AC);

}  // namespace hydroprint::registration
