#pragma once

#include "hardware/depth_camera/depth_frame.h"
#include "sim/image/io/rgb_image.h"

namespace hydroprint::capture {

/// A frame as a picture for display, at half its size.
struct DepthPicture {
  /// Viridis, which is readable for colour-blind people: nearer is brighter. Grey: not measured.
  image::RgbImage picture;
  /// Ends of the colour scale: the 1 % and 99 % quantiles of the measured depths, so that outliers
  /// do not compress the scale.
  int nearest_mm = 0, farthest_mm = 0;
  double measured_share = 0;  ///< fraction of the frame's pixels
};

[[nodiscard]] DepthPicture depth_picture(const depth_camera::DepthFrame& frame);

}  // namespace hydroprint::capture
