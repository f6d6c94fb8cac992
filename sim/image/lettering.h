#pragma once

#include <string_view>

#include "sim/image/picture.h"

namespace hydroprint::image {

/// Draws text with strokes of its own, so that pictures need no font on the machine: lower-case
/// letters, digits, space and "+-.". Other characters leave a gap.
/// @param left_px, baseline_px  where the text starts
/// @param size_px  height of a lower-case x
void draw_text(RgbImage& image, double left_px, double baseline_px, double size_px,
               std::string_view text, const Rgb8& colour);

/// Width that draw_text takes.
[[nodiscard]] double text_width_px(double size_px, std::string_view text);

}  // namespace hydroprint::image
