#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/base/context.h"
#include "sim/scan/camera.h"
#include "sim/scan/fusion.h"

namespace hydroprint::scan {

/// A point of a surface, seen by a camera; frame C.
struct ScanPoint {
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, towards the camera
  double reported_mm = 0;  ///< depth without the fixed pattern, before scaling (Lens::depth_scale)
  /// Standard deviation of the noise that differs between frames, along the optical axis.
  double sigma_mm = 0;
  /// Standard deviation of the constant noise that the pixels of a patch share, along the optical
  /// axis.
  double constant_sigma_mm = 0;
  double usual_constant_mm = 0;  ///< constant_sigma_mm for an unknown fixed pattern
  int u = 0;                     ///< column of the pixel
  int v = 0;                     ///< row of the pixel
  int patch = 0;                 ///< index of its patch, a square of DepthNoise::patch_px pixels
};

/// The points of a fused frame.
struct Cloud {
  Camera camera;
  std::vector<ScanPoint> points;
  std::vector<int> at_pixel;  ///< for each pixel, row by row: index into points; -1: no point

  [[nodiscard]] const ScanPoint* at(int u, int v) const;
};

/// Computes points with normals. The normal is that of a plane through the surrounding pixels on
/// the same surface. Pixels beside a jump in depth are dropped. The camera's known fixed pattern is
/// subtracted first. Returns kInvalidArgument if the lens or the pattern is for another image size,
/// or if the patches of the pattern and of the noise differ.
[[nodiscard]] Result<Cloud> make_cloud(const FusedFrame& fused, const Camera& camera,
                                       const DepthNoise& noise, const Context& context);

}  // namespace hydroprint::scan
