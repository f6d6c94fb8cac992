#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "sim/image/io/rgb_image.h"

namespace hydroprint::image {

/// Draws text with built-in strokes, so that pictures need no installed font. Supports lower-case
/// letters, digits, space and "+-._:/,#()". Other characters leave a gap.
/// @param left_px, baseline_px  start of the text
/// @param size_px  height of a lower-case x
void draw_text(RgbImage& image, double left_px, double baseline_px, double size_px,
               std::string_view text, const Rgb8& colour);

/// Width of a text drawn by draw_text().
[[nodiscard]] double text_width_px(double size_px, std::string_view text);

/// The strokes of the same text as poly-lines, for callers that draw lines themselves. The unit is
/// the height of a lower-case x; the text runs from (0, 0) on the baseline to the right, y up.
[[nodiscard]] std::vector<std::vector<Eigen::Vector2d>> text_strokes(std::string_view text);

/// Thickness of the pen in heights of a lower-case x.
inline constexpr double kPen = 0.17;

}  // namespace hydroprint::image
