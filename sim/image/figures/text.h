#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "sim/image/io/rgb_image.h"

namespace hydroprint::image {

/// Draws text with strokes of its own, so that pictures need no font on the machine: lower-case
/// letters, digits, space and "+-._:/,#()". Other characters leave a gap.
/// @param left_px, baseline_px  where the text starts
/// @param size_px  height of a lower-case x
void draw_text(RgbImage& image, double left_px, double baseline_px, double size_px,
               std::string_view text, const Rgb8& colour);

/// Width that draw_text takes.
[[nodiscard]] double text_width_px(double size_px, std::string_view text);

/// The strokes of the same text as poly-lines, for those who draw lines themselves: in heights of a
/// lower-case x, from (0, 0) on the baseline to the right, y up.
[[nodiscard]] std::vector<std::vector<Eigen::Vector2d>> text_strokes(std::string_view text);

/// Thickness of the pen in heights of a lower-case x.
inline constexpr double kPen = 0.17;

}  // namespace hydroprint::image
