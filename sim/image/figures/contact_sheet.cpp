#include "sim/image/figures/contact_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/image/figures/text.h"
#include "sim/image/io/colour.h"
#include "sim/text/font.h"

namespace hydroprint::image {
namespace {

constexpr int kCaption_px = 44;
constexpr double kLetter_px = 13;  ///< height of a lower-case x
constexpr Rgb8 kPaper = {250, 250, 249}, kInk = {60, 64, 70};

void fill(RgbImage& image, const Window& area,
          const std::function<Eigen::Vector3f(int x, int y)>& coded) {
  for (int y = area.y0; y < area.y1; ++y) {
    for (int x = area.x0; x < area.x1; ++x) {
      const Eigen::Vector3f colour = coded(x, y);
      for (int c = 0; c < 3; ++c) {
        image.at(x, y)[c] = static_cast<std::uint8_t>(std::lround(colour[c] * 255));
      }
    }
  }
}

}  // namespace

Eigen::Vector3f hatch(int x, int y) {
  constexpr int kPeriod = 18, kStripe = 4;  // measured in samples
  return Eigen::Vector3f::Constant((x + y) % kPeriod < kStripe ? 0.38F : 0.68F);
}

Result<RgbImage> draw_sheet(const ObjectViews& views, int legend_px, const Context& context,
                            const std::function<void(ViewDrawing&, std::size_t)>& draw) {
  HP_ASSIGN_OR_RETURN(const text::Font* const font, text::Font::standard());
  const int cell_height = views.height_px + kCaption_px + kMargin_px;
  const int rows = static_cast<int>(views.seen.size()) / views.columns;
  RgbImage sheet{kSheetWidth_px, kMargin_px + rows * cell_height + legend_px, {}};
  sheet.rgb.reserve(3 * static_cast<std::size_t>(sheet.width) * sheet.height);
  for (std::size_t i = 0; i < static_cast<std::size_t>(sheet.width) * sheet.height; ++i) {
    sheet.rgb.insert(sheet.rgb.end(), kPaper.begin(), kPaper.end());
  }
  HP_RETURN_IF_ERROR(parallel_for(context, {}, views.seen.size(), [&](std::size_t v) {
    const int left =
        kMargin_px + static_cast<int>(v) % views.columns * (views.width_px + kMargin_px);
    const int top = kMargin_px + static_cast<int>(v) / views.columns * cell_height;
    ViewDrawing drawing(views.seen[v]);
    draw(drawing, v);
    drawing.put_on(sheet, left, top);
    const std::string& name = views.names[v];
    const double middle = left + 0.5 * views.width_px;
    draw_text(sheet, *font, middle - 0.5 * text_width_px(*font, kLetter_px, name),
              top + views.height_px + 34, kLetter_px, name, kInk);
    return Status{};
  }));
  return sheet;
}

Status draw_legend(RgbImage& sheet, const Scale& scale) {
  HP_ASSIGN_OR_RETURN(const text::Font* const font, text::Font::standard());
  constexpr int kBarWidth = 760, kBarHeight = 24;
  const int left = 330, top = sheet.height - kLegend_px + 8;
  draw_text(sheet, *font, left - 30 - text_width_px(*font, 16, scale.label), top + 20, 16,
            scale.label, kInk);
  fill(sheet, {left, top, left + kBarWidth, top + kBarHeight},
       [&](int x, int) { return scale.coded((x - left + 0.5) / kBarWidth); });
  const int steps =
      static_cast<int>(std::lround((scale.range.high - scale.range.low) / scale.range.step));
  for (int i = 0; i <= steps; ++i) {
    const int x = left + static_cast<int>(std::lround(i * (kBarWidth - 1.0) / steps));
    fill(sheet, {x, top + kBarHeight, x + 1, top + kBarHeight + 7}, [](int, int) {
      return Eigen::Vector3f(Eigen::Vector3f(kInk[0], kInk[1], kInk[2]) / 255.0F);
    });
    const double value = scale.range.low + i * scale.range.step;
    const std::string text = fmt::format("{}", std::round(value * 1e4) / 1e4 + 0.0);  // no -0
    draw_text(sheet, *font, x - 0.5 * text_width_px(*font, kLetter_px, text), top + kBarHeight + 34,
              kLetter_px, text + (i == steps ? "+" : ""), kInk);
  }
  if (scale.hatched.empty()) return {};
  const int box = left + kBarWidth + 70;
  fill(sheet, {box, top, box + 54, top + kBarHeight},
       [](int x, int y) { return srgb_from_linear(hatch(2 * x, 2 * y)); });
  draw_text(sheet, *font, box + 70, top + 19, kLetter_px, scale.hatched, kInk);
  return {};
}

}  // namespace hydroprint::image
