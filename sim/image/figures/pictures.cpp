#include "sim/image/figures/pictures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "sim/image/figures/contact_sheet.h"
#include "sim/image/figures/depth_buffer.h"
#include "sim/image/film/stretch.h"
#include "sim/image/io/colour.h"

namespace hydroprint::image {
namespace {

/// Upper end of the stretch scale. Larger stretches do not matter, because film tears at about 3.
/// At the poles of spheres stretch is in the hundreds and would use up the whole scale.
constexpr double kMostStretch = 4;

/// Upper end of the scale of the stated error: six pixels at 300 dpi.
constexpr double kMostError_mm = 0.5;

/// Colours of evenly increasing lightness, distinguishable with every kind of colour vision: evenly
/// spaced control points, sRGB.
constexpr std::array<Rgb8, 9> kScale = {{{68, 1, 84},
                                         {71, 45, 123},
                                         {59, 82, 139},
                                         {44, 114, 142},
                                         {33, 145, 140},
                                         {40, 174, 128},
                                         {94, 201, 98},
                                         {173, 220, 48},
                                         {253, 231, 37}}};

/// Returns the sRGB-coded colour, in [0, 1], at a position on the scale from 0 (low) to 1 (high).
Eigen::Vector3f scale_colour(double t) {
  const double at = std::clamp(t, 0.0, 1.0) * (kScale.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), kScale.size() - 2);
  const auto share = static_cast<float>(at - static_cast<double>(i));
  const auto point = [](const Rgb8& c) -> Eigen::Vector3f {
    return Eigen::Vector3f(c[0], c[1], c[2]) / 255.0F;
  };
  return point(kScale[i]) * (1 - share) + point(kScale[i + 1]) * share;
}

/// Same as scale_colour(), in linear light, from a table because it is called for every sample.
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
  while (top - quantity.rest > 6 * range.step) range.step *= 10;
  range.low = std::min(quantity.rest, std::floor(at(0.02) / range.step + 1e-9) * range.step);
  range.high = std::ceil(top / range.step - 1e-9) * range.step;
  return range;
}

}  // namespace

Result<RgbImage> quantity_picture(const ObjectViews& views, const Quantity& quantity,
                                  const Context& context) {
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
  HP_ASSIGN_OR_RETURN(RgbImage sheet, draw_sheet(views, kLegend_px, context,
                                                 [&](ViewDrawing& drawing, std::size_t) {
                                                   drawing.draw_tiles(colour_of);
                                                   drawing.draw_bare(hatch);
                                                 }));
  HP_RETURN_IF_ERROR(draw_legend(sheet, {quantity.label, range, scale_colour, quantity.hatched}));
  return sheet;
}

Result<RgbImage> stretch_picture(const ObjectViews& views, const flow::SurfaceMap& map,
                                 const Context& context) {
  const auto at_corners = [&](const flow::MappedTriangle& tile) {
    auto values = tile_stretch(views.surface, map, tile, Stretch::kLargest);
    // A tile whose film has no area (NaN) is stretched without limit.
    for (double& value : values) value = std::isfinite(value) ? value : HUGE_VAL;
    return values;
  };
  std::vector<double> shown = map.stretch;
  for (double& value : shown) {
    if (value > kMostStretch) value = kMostStretch;
  }
  const Quantity stretch{"stretch", shown, 1, 0.1, at_corners};
  return quantity_picture(views, stretch, context);
}

Result<RgbImage> wrinkle_picture(const ObjectViews& views, const flow::SurfaceMap& map,
                                 const Context& context) {
  const auto at_corners = [&](const flow::MappedTriangle& tile) {
    return tile_stretch(views.surface, map, tile, Stretch::kLeast);
  };
  const Quantity least{"least stretch", map.least_stretch, 1, 0.1, at_corners};
  return quantity_picture(views, least, context);
}

Result<RgbImage> error_picture(const ObjectViews& views, const flow::SurfaceMap& map,
                               const Context& context) {
  const auto at_corners = [&](const flow::MappedTriangle& tile) {
    const Eigen::Vector3i& v = views.surface.triangles[tile.triangle];
    const Eigen::Vector3d around(map.error_mm[v[0]], map.error_mm[v[1]], map.error_mm[v[2]]);
    std::array<double, 3> values{};
    for (int i = 0; i < 3; ++i) {
      const double value = tile.barycentric[i].cast<double>().dot(around);
      values[i] = std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN();
    }
    return values;
  };
  std::vector<double> shown = map.error_mm;
  for (double& value : shown) {
    if (value > kMostError_mm) value = kMostError_mm;
  }
  const Quantity error{"error, mm", shown, 0, 0.1, at_corners, "not known"};
  return quantity_picture(views, error, context);
}

Result<RgbImage> predicted_picture(const ObjectViews& views, const FilmTexture& film,
                                   const Context& context) {
  const auto colour_of = [&](const flow::MappedTriangle& tile, const Corners& at) {
    return [brush = film.brush(at, tile.film_mm)](int x, int y, const Eigen::Vector3d&) {
      return brush.at(x + 0.5, y + 0.5);
    };
  };
  return draw_sheet(views, 0, context, [&](ViewDrawing& drawing, std::size_t) {
    drawing.draw_tiles(colour_of);
    drawing.draw_bare([](int, int) { return kBareObject; });
  });
}

}  // namespace hydroprint::image
