#pragma once

#include <Eigen/Core>

#include "sim/scan/cloud.h"

namespace hydroprint::scan {

/// How the points of a camera go with what is not known of it: unknowns that are independent, of
/// mean 0 and standard deviation 1. Nine are the lens's, the others those that only the camera's
/// fixed pattern has (FixedPattern::shared). Refers to the camera.
class CameraErrors {
 public:
  explicit CameraErrors(const Camera& camera);

  [[nodiscard]] Eigen::Index count() const { return count_; }
  /// Derivative of a point's place along a direction by each unknown, mm.
  [[nodiscard]] Eigen::RowVectorXd along(const Eigen::Vector3d& direction,
                                         const ScanPoint& point) const;

 private:
  const Camera& camera_;
  Lens::Matrix root_;  ///< of the lens's covariance
  Eigen::Index count_;
};

}  // namespace hydroprint::scan
