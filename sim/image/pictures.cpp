#include "sim/image/pictures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "sim/image/colour.h"
#include "sim/image/lettering.h"
#include "sim/image/stretch.h"
#include "sim/image/view.h"

namespace hydroprint::image {
namespace {

constexpr int kSheetWidth_px = 1360;
constexpr int kMargin_px = 40;
constexpr int kCaption_px = 44;
constexpr int kLegend_px = 110;
constexpr double kLetter_px = 13;  ///< height of an x
constexpr Rgb8 kPaper = {250, 250, 249}, kInk = {60, 64, 70};
/// Differences of stretch beyond it say nothing: film tears at about 3. The poles of spheres, where
/// it is hundreds, would take the whole scale.
constexpr double kMostStretch = 4;
const Eigen::Vector3f kBareObject(0.72F, 0.72F, 0.71F);  // linear

/// From dark to light at an even pace, and apart for every kind of colour vision: control points of
/// sRGB colours, evenly spaced.
constexpr std::array<Rgb8, 9> kScale = {{{68, 1, 84},
                                         {71, 45, 123},
                                         {59, 82, 139},
                                         {44, 114, 142},
                                         {33, 145, 140},
                                         {40, 174, 128},
                                         {94, 201, 98},
                                         {173, 220, 48},
                                         {253, 231, 37}}};

/// sRGB-coded, [0, 1]
Eigen::Vector3f scale_colour(double t) {
  const double at = std::clamp(t, 0.0, 1.0) * (kScale.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), kScale.size() - 2);
  const auto share = static_cast<float>(at - static_cast<double>(i));
  const auto point = [](const Rgb8& c) -> Eigen::Vector3f {
    return Eigen::Vector3f(c[0], c[1], c[2]) / 255.0F;
  };
  return point(kScale[i]) * (1 - share) + point(kScale[i + 1]) * share;
}

/// The same in linear light, by table: it is asked for every sample.
const Eigen::Vector3f& linear_scale_colour(double t) {
  constexpr int kLast = 1023;
  static const std::vector<Eigen::Vector3f> table = [] {
    std::vector<Eigen::Vector3f> colours;
    for (int i = 0; i <= kLast; ++i) {
      colours.push_back(linear_from_srgb(scale_colour(static_cast<double>(i) / kLast)));
    }
    return colours;
  }();
  return table[static_cast<std::size_t>(std::clamp(t, 0.0, 1.0) * kLast + 0.5)];
}

/// Diagonal stripes in two greys.
Eigen::Vector3f hatch(int x, int y) {
  constexpr int kPeriod = 18, kStripe = 4;  // in samples
  return Eigen::Vector3f::Constant((x + y) % kPeriod < kStripe ? 0.38F : 0.68F);
}

/// Range of a scale, and where its numbers stand.
struct Range {
  double low = 1, high = 2, step = 0.2;
};

Range range_of(const Quantity& quantity) {
  std::vector<double> sorted;
  for (const double value : quantity.values) {
    if (std::isfinite(value)) sorted.push_back(value);
  }
  if (sorted.empty()) sorted = {quantity.rest};
  std::sort(sorted.begin(), sorted.end());
  const auto at = [&](double part) {
    return sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
  };
  const double top = std::max(at(0.98), quantity.rest + quantity.least_span);
  Range range;
  for (const double step : {0.0002, 0.0005, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5,
                            1.0, 2.0, 5.0, 10.0, 50.0, 1000.0}) {
    range.step = step;
    if (top - quantity.rest <= 6 * step) break;
  }
  range.low = std::min(quantity.rest, std::floor(at(0.02) / range.step + 1e-9) * range.step);
  range.high = std::ceil(top / range.step - 1e-9) * range.step;
  return range;
}

std::string number(double value) {
  std::string text = std::to_string(std::round(value * 1e4) / 1e4);
  text.resize(text.find('.') + 5);
  while (text.back() == '0' && text[text.size() - 2] != '.') text.pop_back();
  return text;
}

/// Where the views stand on the sheet.
struct Layout {
  std::vector<View> views;
  int columns = 2, rows = 2;
  int cell_width = 0, cell_height = 0;
  double px_per_mm = 1;
  int height = 0;
};

/// Two by two or four in a row: the compact row unless it shows the object much smaller.
Layout lay_out(const mesh::Surface& surface, const Pose& X_FO, int legend_px) {
  Layout best;
  double best_score = 0;
  Eigen::Vector2d half = Eigen::Vector2d::Constant(1e-6);
  const std::vector<View> views = standard_views();
  for (const View& view : views) half = half.cwiseMax(half_extent_mm(surface, X_FO, view));
  for (const int columns : {2, 4}) {
    Layout layout;
    layout.views = views;
    layout.columns = columns;
    layout.rows = 4 / columns;
    layout.cell_width = (kSheetWidth_px - (columns + 1) * kMargin_px) / columns;
    const double limit = (columns == 4 ? 765.0 : 1020.0) / layout.rows;
    layout.px_per_mm =
        std::min((layout.cell_width - 8) / (2 * half.x()), (limit - 8) / (2 * half.y()));
    layout.cell_height = static_cast<int>(2 * half.y() * layout.px_per_mm) + 9;
    layout.height =
        kMargin_px + layout.rows * (layout.cell_height + kCaption_px + kMargin_px) + legend_px;
    const double score = layout.px_per_mm * (columns == 2 ? 0.8 : 1.0);
    if (score > best_score) {
      best_score = score;
      best = layout;
    }
  }
  return best;
}

using DrawView = std::function<void(ViewDrawing&)>;

Result<RgbImage> draw_sheet(const mesh::Surface& surface, const Pose& X_FO, int legend_px,
                            const Context& context, const DrawView& draw) {
  const Layout layout = lay_out(surface, X_FO, legend_px);
  RgbImage sheet{kSheetWidth_px, layout.height, {}};
  sheet.rgb.reserve(3 * static_cast<std::size_t>(sheet.width) * sheet.height);
  for (std::size_t i = 0; i < static_cast<std::size_t>(sheet.width) * sheet.height; ++i) {
    sheet.rgb.insert(sheet.rgb.end(), kPaper.begin(), kPaper.end());
  }
  HP_RETURN_IF_ERROR(parallel_for(context, {}, layout.views.size(), [&](std::size_t v) {
    const int column = static_cast<int>(v) % layout.columns;
    const int row = static_cast<int>(v) / layout.columns;
    const int left = kMargin_px + column * (layout.cell_width + kMargin_px);
    const int top = kMargin_px + row * (layout.cell_height + kCaption_px + kMargin_px);
    ViewDrawing drawing(surface, X_FO, layout.views[v], layout.cell_width, layout.cell_height,
                        layout.px_per_mm);
    draw(drawing);
    drawing.put_on(sheet, left, top);
    const std::string& name = layout.views[v].name;
    const double middle = left + 0.5 * layout.cell_width;
    draw_text(sheet, middle - 0.5 * text_width_px(kLetter_px, name), top + layout.cell_height + 34,
              kLetter_px, name, kInk);
    return Status{};
  }));
  return sheet;
}

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

void draw_legend(RgbImage& sheet, const std::string& label, const Range& range) {
  constexpr int kBarWidth = 760, kBarHeight = 24;
  const int left = 330, top = sheet.height - kLegend_px + 8;
  draw_text(sheet, left - 30 - text_width_px(16, label), top + 20, 16, label, kInk);
  fill(sheet, {left, top, left + kBarWidth, top + kBarHeight},
       [&](int x, int) { return scale_colour((x - left + 0.5) / kBarWidth); });
  const int steps = static_cast<int>(std::lround((range.high - range.low) / range.step));
  for (int i = 0; i <= steps; ++i) {
    const int x = left + static_cast<int>(std::lround(i * (kBarWidth - 1.0) / steps));
    fill(sheet, {x, top + kBarHeight, x + 1, top + kBarHeight + 7}, [](int, int) {
      return Eigen::Vector3f(Eigen::Vector3f(kInk[0], kInk[1], kInk[2]) / 255.0F);
    });
    const std::string text = number(range.low + i * range.step) + (i == steps ? "+" : "");
    draw_text(sheet, x - 0.5 * text_width_px(kLetter_px, number(range.low + i * range.step)),
              top + kBarHeight + 34, kLetter_px, text, kInk);
  }
  const int box = left + kBarWidth + 70;
  fill(sheet, {box, top, box + 54, top + kBarHeight},
       [](int x, int y) { return srgb_from_linear(hatch(2 * x, 2 * y)); });
  draw_text(sheet, box + 70, top + 19, kLetter_px, "no film", kInk);
}

}  // namespace

Result<RgbImage> quantity_picture(const mesh::Surface& surface, const Pose& X_FO,
                                  const std::vector<flow::MappedTriangle>& tiles,
                                  const Quantity& quantity, const Context& context) {
  const Range range = range_of(quantity);
  const auto colour_of = [&](const flow::MappedTriangle& tile, const Corners&) {
    const auto values = quantity.at_corners(tile);
    return [values, &range](int x, int y, const Eigen::Vector3d& b) -> Eigen::Vector3f {
      const double value = b[0] * values[0] + b[1] * values[1] + b[2] * values[2];
      if (std::isnan(value)) return hatch(x, y);
      const double t = (value - range.low) / (range.high - range.low);
      return linear_scale_colour(t);
    };
  };
  HP_ASSIGN_OR_RETURN(RgbImage sheet,
                      draw_sheet(surface, X_FO, kLegend_px, context, [&](ViewDrawing& drawing) {
                        drawing.place_surface();
                        drawing.draw_tiles(tiles, colour_of);
                        drawing.draw_bare(hatch);
                      }));
  draw_legend(sheet, quantity.label, range);
  return sheet;
}

Result<RgbImage> stretch_picture(const mesh::Surface& surface, const Pose& X_FO,
                                 const flow::FlowMap& map, const Context& context) {
  const auto at_corners = [&](const flow::MappedTriangle& tile) {
    auto values = tile_stretch(surface, map.surface, tile, Stretch::kLargest);
    // Film that lands without having any area: stretched beyond measure.
    for (double& value : values) value = std::isfinite(value) ? value : HUGE_VAL;
    return values;
  };
  std::vector<double> shown = map.surface.stretch;
  for (double& value : shown) {
    if (value > kMostStretch) value = kMostStretch;
  }
  const Quantity stretch{"stretch", shown, 1, 0.1, at_corners};
  return quantity_picture(surface, X_FO, map.tiles, stretch, context);
}

Result<RgbImage> wrinkle_picture(const mesh::Surface& surface, const Pose& X_FO,
                                 const flow::FlowMap& map, const Context& context) {
  const auto at_corners = [&](const flow::MappedTriangle& tile) {
    return tile_stretch(surface, map.surface, tile, Stretch::kLeast);
  };
  const Quantity least{"least stretch", map.surface.least_stretch, 1, 0.1, at_corners};
  return quantity_picture(surface, X_FO, map.tiles, least, context);
}

Result<RgbImage> predicted_picture(const mesh::Surface& surface, const Pose& X_FO,
                                   const std::vector<flow::MappedTriangle>& tiles,
                                   const FilmTexture& film, const Context& context) {
  const auto colour_of = [&](const flow::MappedTriangle& tile, const Corners& at) {
    return [brush = film.brush(at, tile.film_mm)](int x, int y, const Eigen::Vector3d&) {
      return brush.at(x + 0.5, y + 0.5);
    };
  };
  return draw_sheet(surface, X_FO, 0, context, [&](ViewDrawing& drawing) {
    drawing.place_surface();
    drawing.draw_tiles(tiles, colour_of);
    drawing.draw_bare([](int, int) { return kBareObject; });
  });
}

}  // namespace hydroprint::image
