#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "sim/image/io/rgb_image.h"

namespace hydroprint::image {

/// Blends a colour into a pixel (R, G, B) with a weight from 0 to 1.
void mix_in(std::uint8_t* pixel, const Rgb8& colour, double share);

/// Draws a line with round ends, or a dot if both ends are equal. Parts outside the image are
/// clipped.
/// @param from_px, to_px  x to the right, y down; pixel (x, y) has its centre at (x + 1/2, y + 1/2)
void draw_line(RgbImage& image, const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px,
               double width_px, const Rgb8& colour);

}  // namespace hydroprint::image
