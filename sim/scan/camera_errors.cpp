#include "sim/scan/camera_errors.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace hydroprint::scan {

CameraErrors::CameraErrors(const Camera& camera)
    : camera_(camera),
      root_(camera.covariance.llt().matrixL()),
      count_(std::max<Eigen::Index>(Lens::kParameters, camera.pattern.shared.rows())) {}

Eigen::RowVectorXd CameraErrors::along(const Eigen::Vector3d& direction,
                                       const ScanPoint& point) const {
  Eigen::RowVectorXd out = Eigen::RowVectorXd::Zero(count_);
  out.head<Lens::kParameters>() =
      direction.transpose() * camera_.lens.derivatives(point.u, point.v, point.reported_mm) * root_;
  const FixedPattern& pattern = camera_.pattern;
  if (!pattern.is_known()) return out;
  // The offset is subtracted, so a positive error of the offset moves the point towards the camera.
  const double per_offset =
      -direction.dot(point.point_mm) / point.point_mm.z() * point.usual_constant_mm;
  out += per_offset * pattern.shared.col(point.patch)
                          .cast<double>()
                          .cwiseProduct(pattern.step.cast<double>())
                          .transpose();
  return out;
}

}  // namespace hydroprint::scan
