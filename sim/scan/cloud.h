#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/base/context.h"
#include "sim/scan/camera.h"
#include "sim/scan/fusion.h"

namespace hydroprint::scan {

/// A point of a surface as a camera sees it, frame C.
struct ScanPoint {
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, towards the camera
  double reported_mm = 0;        ///< depth before the lens's scale, the camera's pattern taken off
  double sigma_mm = 0;           ///< along the axis, of what changes between frames
  double constant_sigma_mm = 0;  ///< along the axis, of what does not, and that a patch shares
  double usual_constant_mm = 0;  ///< the same where nothing is known of the camera's pattern
  int u = 0;                     ///< pixel
  int v = 0;
  int patch = 0;  ///< which square of DepthNoise::patch_px
};

/// The points of a fused frame.
struct Cloud {
  Camera camera;
  std::vector<ScanPoint> points;
  std::vector<int> at_pixel;  ///< per pixel, row after row: index into points, -1: none

  [[nodiscard]] const ScanPoint* at(int u, int v) const;
};

/// Points with normals (plane through the pixels around that lie on the same surface), but for
/// pixels beside a jump in depth, which are no surface's.
/// What is known of the camera's fixed pattern is taken off first.
/// Refuses (kInvalidArgument) a lens made for another image size, and a pattern of another, or of
/// other patches than the noise's.
[[nodiscard]] Result<Cloud> make_cloud(const FusedFrame& fused, const Camera& camera,
                                       const DepthNoise& noise, const Context& context);

}  // namespace hydroprint::scan
