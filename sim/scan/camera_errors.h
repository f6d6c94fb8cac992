#pragma once

#include <Eigen/Core>

#include "sim/scan/cloud.h"

namespace hydroprint::scan {

/// Derivatives of a camera's points by the unknowns of its calibration. The unknowns are
/// independent, with mean 0 and standard deviation 1. The first nine are the lens's, the others
/// belong only to the fixed pattern (FixedPattern::shared). Keeps a reference to the camera.
class CameraErrors {
 public:
  explicit CameraErrors(const Camera& camera);

  [[nodiscard]] Eigen::Index count() const { return count_; }
  /// Derivative of a point's position along a direction by each unknown, mm.
  [[nodiscard]] Eigen::RowVectorXd along(const Eigen::Vector3d& direction,
                                         const ScanPoint& point) const;

 private:
  const Camera& camera_;
  Lens::Matrix root_;  ///< Cholesky factor of the lens's covariance
  Eigen::Index count_;
};

}  // namespace hydroprint::scan
