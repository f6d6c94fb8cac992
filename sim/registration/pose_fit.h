#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/base/context.h"
#include "sim/registration/shape.h"
#include "sim/registration/twist.h"
#include "sim/scan/cloud.h"

namespace hydroprint::registration {

/// A motion of the body that the scan says nothing of, so that the nominal pose is believed.
struct WeakDirection {
  /// Camera frame, about PoseFit::centre_mm; as long as to move the surface by 1 mm (rms).
  Vector6 twist = Vector6::Zero();
  double sigma_mm = 0;  ///< by which the surface could be off, had the scan been believed
};

/// Where a body is, and how well that is known.
struct PoseFit {
  Pose X_CB = Pose::Identity();
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();  ///< camera frame; twists are about it
  /// Of the twist (camera frame) between X_CB and the truth, from the depths' noise, and from the
  /// nominal pose's uncertainty along weak directions. Radians and mm.
  Matrix6 covariance = Matrix6::Zero();
  /// How that twist goes with what is not known of the camera, which `covariance` leaves out: the
  /// gain times itself transposed comes to it.
  CameraGain camera_gain = CameraGain::Zero(6, 0);
  std::vector<WeakDirection> weak;
  std::size_t points = 0;   ///< that were paired with the surface
  double paired_share = 0;  ///< of the points given that lie on the surface within their noise
  double rms_mm = 0;        ///< of the distances of those
  double rms_sigmas = 0;    ///< the same in units of what noise explains, of a camera whose fixed
                            ///< pattern is not known; as the share above
};

struct FitOptions {
  /// Directions that the scan tells worse than this are taken from the nominal pose.
  double weak_sigma_mm = 1;
  double nominal_turn_sigma_rad = 0.1;
  double nominal_shift_sigma_mm = 10;
  double reach_mm = 10;  ///< points farther from the surface at the start are not paired
  int most_iterations = 60;
};

/// Least squares of the distances of scan points from a surface, along its normals, weighted by
/// each point's noise and by how little of it is explained (Tukey), from a start within a few mm
/// and degrees. What is known of the camera's fixed pattern decides at last only what belongs to
/// the surface. The covariance counts that part of the noise which a patch of pixels shares.
/// Refuses (kFailedPrecondition) fewer than 30 points on the surface.
[[nodiscard]] Result<PoseFit> fit_pose(const Shape& shape, std::span<const scan::ScanPoint> points,
                                       const scan::Camera& camera, const Pose& start_CB,
                                       const Pose& nominal_CB, const FitOptions& options,
                                       const Context& context);

/// Registration error (rms over its distribution) that a pose's covariance means at points, mm.
/// @param covariance  of a twist in the frame of the points, about `centre_mm`
[[nodiscard]] std::vector<double> error_at(std::span<const Eigen::Vector3d> points_mm,
                                           const Eigen::Vector3d& centre_mm,
                                           const Matrix6& covariance);

/// "turn about the axis through (x, y, z) along (x, y, z)" or "shift along (x, y, z)", given in the
/// frame that `X_AC` leads to.
[[nodiscard]] std::string describe(const WeakDirection& direction, const Eigen::Vector3d& centre_C,
                                   const Pose& X_AC);

}  // namespace hydroprint::registration
