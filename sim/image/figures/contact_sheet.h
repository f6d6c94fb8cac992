#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/figures/depth_buffer.h"
#include "sim/image/figures/object_views.h"
#include "sim/image/io/rgb_image.h"

namespace hydroprint::image {

/// Height of the space for a legend below the views of a sheet.
inline constexpr int kLegend_px = 110;

/// Linear colour of an object without film.
inline const Eigen::Vector3f kBareObject(0.72F, 0.72F, 0.71F);

/// Draws the standard views on one sheet, with their names, calling `draw` with the drawing and the
/// index of each, and keeps space for a legend below.
[[nodiscard]] Result<RgbImage> draw_sheet(
    const ObjectViews& views, int legend_px, const Context& context,
    const std::function<void(ViewDrawing&, std::size_t)>& draw);

/// Returns the linear colour, at a sample, of diagonal stripes in two greys. The stripes mark areas
/// without a value.
[[nodiscard]] Eigen::Vector3f hatch(int x, int y);

/// Range of a scale, and the step between its labels.
struct Range {
  double low = 1, high = 2, step = 0.2;
};

/// The meaning of a sheet's colours.
struct Scale {
  std::string label;
  Range range;
  /// Returns the sRGB-coded colour for a position in the range, from 0 (low) to 1 (high).
  std::function<Eigen::Vector3f(double)> coded;
  std::string hatched;  ///< legend label of areas with hatch(); empty: not in the legend
};

/// Draws a legend into the space that draw_sheet() kept for it. Returns the errors of
/// text::Font::standard().
[[nodiscard]] Status draw_legend(RgbImage& sheet, const Scale& scale);

}  // namespace hydroprint::image
