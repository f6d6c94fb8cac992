#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/base/context.h"
#include "sim/registration/shape.h"
#include "sim/registration/twist.h"
#include "sim/scan/cloud.h"

namespace hydroprint::registration {

/// A motion of the body that the scan does not determine; the fit takes it from the nominal pose.
struct WeakDirection {
  /// Camera frame, about PoseFit::centre_mm. Scaled so that it moves the surface by 1 mm (rms).
  Vector6 twist = Vector6::Zero();
  double sigma_mm = 0;  ///< standard error of the surface along this motion, from the scan alone
};

/// Pose of a body and its uncertainty.
struct PoseFit {
  Pose X_CB = Pose::Identity();
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();  ///< camera frame; origin of the twists
  /// Covariance of the twist (camera frame) between X_CB and the true pose, in radians and mm. It
  /// includes the noise of the depths and, along weak directions, the nominal pose's uncertainty.
  Matrix6 covariance = Matrix6::Zero();
  /// Derivative of that twist with respect to the camera's unknowns. `covariance` does not include
  /// them; their contribution is camera_gain * camera_gain^T.
  CameraGain camera_gain = CameraGain::Zero(6, 0);
  /// Without turns about FitOptions::symmetry_axes.
  std::vector<WeakDirection> weak;
  /// Number of points that lie on the surface within their noise, and their fraction of all given
  /// points. The noise, here and in rms_sigmas, is that of a camera with an unknown fixed pattern.
  std::size_t points = 0;
  double paired_share = 0;
  double rms_mm = 0;      ///< rms distance of these points
  double rms_sigmas = 0;  ///< the same distances in units of their noise
};

struct FitOptions {
  /// Motions with a larger standard error are taken from the nominal pose.
  double weak_sigma_mm = 1;
  double nominal_turn_sigma_rad = 0.1;
  double nominal_shift_sigma_mm = 10;
  double reach_mm = 10;  ///< points that start farther from the surface are not paired
  /// Axes of symmetry_axes(). Turns about them are taken from the nominal pose; as they leave the
  /// surface in place, they do not count in the covariance.
  std::vector<Eigen::Vector3d> symmetry_axes;
  int most_iterations = 60;
};

/// Fits a pose by least squares over the distances of scan points to a surface, measured along its
/// normals. Each point is weighted by the inverse variance of its noise and by Tukey's weight. The
/// initial pose must be within a few mm and degrees of the true pose. Only the last iterations use
/// the camera's fixed pattern to decide which points lie on the surface. The covariance accounts
/// for noise that is correlated within patches of pixels. Returns kFailedPrecondition
/// (TOO_FEW_POINTS) if fewer than 30 points can be paired with the surface.
[[nodiscard]] Result<PoseFit> fit_pose(const Shape& shape, std::span<const scan::ScanPoint> points,
                                       const scan::Camera& camera, const Pose& start_CB,
                                       const Pose& nominal_CB, const FitOptions& options,
                                       const Context& context);

/// Computes the registration error (rms over its distribution, mm) at each point from the
/// covariance of a pose.
/// @param covariance  of a twist in the frame of the points, about `centre_mm`
[[nodiscard]] std::vector<double> error_at(std::span<const Eigen::Vector3d> points_mm,
                                           const Eigen::Vector3d& centre_mm,
                                           const Matrix6& covariance);

/// Returns "turn about the axis through (x, y, z) along (x, y, z)" or "shift along (x, y, z)", in
/// frame A.
[[nodiscard]] std::string describe(const WeakDirection& direction, const Eigen::Vector3d& centre_C,
                                   const Pose& X_AC);

/// Returns "any turn about (x, y, z)" or "turn about the axis through (x, y, z) along (x, y, z)",
/// in frame A, for the axes of symmetry_axes(); "" if there are none.
[[nodiscard]] std::string describe_symmetry(std::span<const Eigen::Vector3d> axes_B,
                                            const Eigen::Vector3d& centroid_B, const Pose& X_AB);

}  // namespace hydroprint::registration
