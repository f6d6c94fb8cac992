#include "sim/image/figures/text.h"

#include <algorithm>

#include "sim/image/figures/strokes.h"

namespace hydroprint::image {
namespace {

void draw_glyph(RgbImage& image, const text::Coverage& glyph, const Rgb8& colour) {
  const int x0 = std::max(0, glyph.left), x1 = std::min(image.width, glyph.left + glyph.width);
  const int y0 = std::max(0, glyph.top), y1 = std::min(image.height, glyph.top + glyph.height);
  for (int y = y0; y < y1; ++y) {
    const std::uint8_t* const row =
        &glyph.samples[static_cast<std::size_t>(y - glyph.top) * glyph.width];
    for (int x = x0; x < x1; ++x) mix_in(image.at(x, y), colour, row[x - glyph.left] / 255.0);
  }
}

}  // namespace

void draw_text(RgbImage& image, const text::Font& font, double left_px, double baseline_px,
               double size_px, std::string_view text, const Rgb8& colour) {
  for (const text::PlacedGlyph& placed : font.lay_out(text).glyphs) {
    const Eigen::Vector2d origin(left_px + placed.left * size_px, baseline_px);
    draw_glyph(image, font.rasterize(placed.glyph, origin, size_px), colour);
  }
}

double text_width_px(const text::Font& font, double size_px, std::string_view text) {
  return size_px * font.lay_out(text).width;
}

}  // namespace hydroprint::image
