#pragma once

#include <vector>

#include "sim/scan/volume.h"

namespace hydroprint::scan {

/// Where a camera was, found by what it saw against a volume.
struct Tracked {
  Pose X_WC = Pose::Identity();
  double matched_share = 0;  ///< of the frame's points
  double rms_mm = 0;         ///< of the matched points, along their rays
  double sigma_mm = 0;       ///< standard error of the pose in its worst direction, at the scene
};

/// Points of a frame to track it by, camera frame: each the mean of a block of pixels that lie on
/// one surface. The noise that they share does not become less by looking closer.
[[nodiscard]] std::vector<Eigen::Vector3d> tracking_points(const DepthFrame& frame,
                                                           const Optics& optics);

/// The pose of points that brings the volume's distances at them to zero (Bylow et al., Real-time
/// camera tracking and 3D reconstruction using signed distance functions, RSS 2013).
/// @param guess  of X_WC
/// Refuses (kFailedPrecondition, CAMERA_LOST) where too little matches, or what does leaves a
/// motion open.
[[nodiscard]] Result<Tracked> track(const std::vector<Eigen::Vector3d>& points,
                                    const DepthNoise& noise, const Volume& volume,
                                    const Pose& guess, const Context& context);

}  // namespace hydroprint::scan
