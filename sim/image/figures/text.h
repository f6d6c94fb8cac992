#pragma once

#include <string_view>

#include "sim/image/io/rgb_image.h"
#include "sim/text/font.h"

namespace hydroprint::image {

/// Draws a line of UTF-8. Parts beyond the image are left out. The same pixels for any number of
/// threads.
/// @param left_px, baseline_px  where the text starts
/// @param size_px  height of a lower-case x
void draw_text(RgbImage& image, const text::Font& font, double left_px, double baseline_px,
               double size_px, std::string_view text, const Rgb8& colour);

/// Width that draw_text takes.
[[nodiscard]] double text_width_px(const text::Font& font, double size_px, std::string_view text);

}  // namespace hydroprint::image
