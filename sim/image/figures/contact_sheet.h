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

/// Height of the room for a legend below the views of a sheet.
inline constexpr int kLegend_px = 110;

/// The standard views on one sheet, each drawn by `draw`, with their names, and room for a legend
/// below. Fails as text::Font::standard() does.
[[nodiscard]] Result<RgbImage> draw_sheet(const ObjectViews& views, int legend_px,
                                          const Context& context,
                                          const std::function<void(ViewDrawing&)>& draw);

/// Diagonal stripes in two greys (linear), by samples of a drawing: there is nothing to tell.
[[nodiscard]] Eigen::Vector3f hatch(int x, int y);

/// Range of a scale, and where its numbers stand.
struct Range {
  double low = 1, high = 2, step = 0.2;
};

/// What a sheet's colours mean.
struct Scale {
  std::string label;
  Range range;
  std::function<Eigen::Vector3f(double)> coded;  ///< sRGB-coded, of the range as [0, 1]
  std::string hatched;                           ///< what hatch() stands for; empty: nothing
};

/// Draws one into the room that draw_sheet() left for it. Fails as text::Font::standard() does.
[[nodiscard]] Status draw_legend(RgbImage& sheet, const Scale& scale);

}  // namespace hydroprint::image
