#pragma once

#include <string_view>

#include "sim/image/io/rgb_image.h"
#include "sim/text/font.h"

namespace hydroprint::image {

/// Draws a line of UTF-8 text. Characters that the font lacks are drawn as U+FFFD
/// (text::Font::lay_out).
/// @param left_px, baseline_px  start of the text
/// @param size_px  height of a lower-case x
void draw_text(RgbImage& image, const text::Font& font, double left_px, double baseline_px,
               double size_px, std::string_view text, const Rgb8& colour);

/// Returns the width of a text drawn by draw_text().
[[nodiscard]] double text_width_px(const text::Font& font, double size_px, std::string_view text);

}  // namespace hydroprint::image
