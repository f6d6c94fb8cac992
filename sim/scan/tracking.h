#pragma once

#include <vector>

#include "sim/scan/volume.h"

namespace hydroprint::scan {

/// Pose of a camera, found by registering its frame to a volume.
struct Tracked {
  Pose X_WC = Pose::Identity();
  double matched_share = 0;  ///< fraction of the frame's points that were matched
  double rms_mm =
      0;  ///< rms distance of the matched points from the volume's surface, along their rays
  /// Standard error of the pose along the motion that the matches determine worst. Rotations are
  /// converted to mm with a lever arm of 200 mm.
  double sigma_mm = 0;
};

/// Returns points for tracking a frame, in the camera frame. Each is the mean of a block of pixels
/// on one surface. Smaller blocks would not help, because the pixels of a block share their noise.
[[nodiscard]] std::vector<Eigen::Vector3d> tracking_points(const DepthFrame& frame,
                                                           const Optics& optics);

/// Finds the pose for which the volume's distances at the points are zero (Bylow et al., Real-time
/// camera tracking and 3D reconstruction using signed distance functions, RSS 2013). Returns
/// kFailedPrecondition (CAMERA_LOST) if too few points match, or if the matches do not determine
/// the whole motion.
/// @param guess  initial value of X_WC
[[nodiscard]] Result<Tracked> track(const std::vector<Eigen::Vector3d>& points,
                                    const DepthNoise& noise, const Volume& volume,
                                    const Pose& guess, const Context& context);

}  // namespace hydroprint::scan
