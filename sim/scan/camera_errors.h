#pragma once

#include <Eigen/Core>

#include "sim/scan/cloud.h"

namespace hydroprint::scan {

/// Derivatives of a camera's points with respect to the unknowns of its calibration. The unknowns
/// are independent, with mean 0 and standard deviation 1. The first nine are those of the lens; the
/// others belong to the fixed pattern (FixedPattern::shared). Keeps a reference to the camera.
class CameraErrors {
 public:
  explicit CameraErrors(const Camera& camera);

  [[nodiscard]] Eigen::Index count() const { return count_; }
  /// Returns the derivative of a point's position along a direction with respect to each unknown,
  /// mm.
  [[nodiscard]] Eigen::RowVectorXd along(const Eigen::Vector3d& direction,
                                         const ScanPoint& point) const;

 private:
  const Camera& camera_;
  Lens::Matrix root_;  ///< Cholesky factor of the lens's covariance
  Eigen::Index count_;
};

}  // namespace hydroprint::scan
