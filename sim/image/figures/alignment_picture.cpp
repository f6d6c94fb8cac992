#include "sim/image/figures/alignment_picture.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/base/check.h"
#include "sim/image/figures/contact_sheet.h"
#include "sim/image/io/colour.h"

namespace hydroprint::image {
namespace {

constexpr double kPoint_mm = 0.7;  ///< radius of the disc that shows a point
constexpr double kDeep_mm = 3;     ///< points deeper below the surface (far side) are hidden
constexpr double kShown = 0.98;    ///< share of the points that the scale covers
constexpr int kSteps = 5;          ///< number of steps of the scale in each direction
const Eigen::Vector3f kObject(0.45F, 0.45F, 0.44F);  // linear

/// Returns a colour from blue (0) through white to red (1), with equal lightness on both sides
/// (ColorBrewer's RdBu); sRGB-coded.
Eigen::Vector3f diverging(double t) {
  const Eigen::Vector3f blue(0.13F, 0.40F, 0.67F), white(0.97F, 0.97F, 0.97F),
      red(0.70F, 0.09F, 0.17F);
  const auto off = static_cast<float>(2 * std::clamp(t, 0.0, 1.0) - 1);
  return off < 0 ? Eigen::Vector3f(white - off * (blue - white))
                 : Eigen::Vector3f(white + off * (red - white));
}

/// Returns a range that is symmetric about zero.
Range range_of(std::span<const double> off_mm) {
  std::vector<double> sorted;
  for (const double x : off_mm) sorted.push_back(std::abs(x));
  std::sort(sorted.begin(), sorted.end());
  const double most =
      sorted.empty()
          ? 0
          : sorted[static_cast<std::size_t>(kShown * static_cast<double>(sorted.size() - 1))];
  double step = 0.1;
  for (const double wider : {0.2, 0.5, 1.0, 2.0, 5.0})
    if (most > kSteps * step) step = wider;
  return {-kSteps * step, kSteps * step, step};
}

}  // namespace

Result<RgbImage> alignment_picture(const ObjectViews& views,
                                   std::span<const Eigen::Vector3d> points_O,
                                   std::span<const double> off_mm, const Context& context) {
  HP_CHECK(off_mm.size() == points_O.size());
  const Range range = range_of(off_mm);
  std::vector<Eigen::Vector3f> colours;
  for (const double x : off_mm)
    colours.push_back(linear_from_srgb(diverging((x - range.low) / (range.high - range.low))));
  const auto draw = [&](ViewDrawing& drawing, std::size_t) {
    drawing.draw_bare([](int, int) { return kObject; });
    drawing.draw_points(points_O, colours, kPoint_mm, kDeep_mm);
  };
  HP_ASSIGN_OR_RETURN(RgbImage sheet, draw_sheet(views, kLegend_px, context, draw));
  HP_RETURN_IF_ERROR(draw_legend(sheet, {"mm off", range, diverging, {}}));
  return sheet;
}

}  // namespace hydroprint::image
