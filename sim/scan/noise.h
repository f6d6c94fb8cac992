#pragma once

#include <cmath>

namespace hydroprint::scan {

/// Depth noise of a structured-light camera. The standard deviation is that of Nguyen, Izadi and
/// Lovell (Modeling Kinect sensor noise, 3DIMPVT 2012) for a first-generation Kinect. Averaging
/// frames removes only the part that differs from frame to frame.
struct DepthNoise {
  double least_mm = 1.2;
  double growth_mm_per_m2 = 1.9;
  double least_at_mm = 400;
  double constant_share = 0.5;  ///< fraction of the variance that is the same in every frame
  int patch_px = 4;  ///< side of a patch: the pixels in this square share the constant part

  /// Returns the standard deviation of one pixel in one frame, including constant and changing
  /// noise.
  [[nodiscard]] double sigma_mm(double depth_mm) const {
    const double away_m = (depth_mm - least_at_mm) / 1000;
    return least_mm + growth_mm_per_m2 * away_m * away_m;
  }
  [[nodiscard]] double constant_sigma_mm(double depth_mm) const {
    return std::sqrt(constant_share) * sigma_mm(depth_mm);
  }
  [[nodiscard]] double changing_sigma_mm(double depth_mm) const {
    return std::sqrt(1 - constant_share) * sigma_mm(depth_mm);
  }
};

}  // namespace hydroprint::scan
