#pragma once

#include "hardware/depth_camera/depth_frame.h"
#include "sim/image/io/rgb_image.h"

namespace hydroprint::capture {

/// A frame for people to look at, at half its size.
struct DepthPicture {
  /// Viridis, which colour-blind people can read, too: the nearer the brighter. Grey: not measured.
  image::RgbImage picture;
  /// Where the colours begin and end: a hundredth of what was measured is nearer, and a hundredth
  /// farther, so that a stray point does not flatten all else.
  int nearest_mm = 0, farthest_mm = 0;
  double measured_share = 0;  ///< of the frame's pixels
};

[[nodiscard]] DepthPicture depth_picture(const depth_camera::DepthFrame& frame);

}  // namespace hydroprint::capture
