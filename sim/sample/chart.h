#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "sim/sample/painting.h"

namespace hydroprint::sample {

/// A rectangle of the texture, in mm of surface: its place in the sheet and what is drawn there.
struct Chart {
  Eigen::Vector2d origin_mm;  ///< in the sheet, of the chart's lower left corner
  Eigen::Vector2d size_mm;
  std::function<Colour(double x_mm, double y_mm)> colour_at;  ///< of places in the chart
};

/// The charts side by side on one texture, with gutters in which their pictures go on, so that
/// filters find no foreign colour.
struct Sheet {
  Eigen::Vector2d size_mm;
  double px_per_mm = 8;
  std::vector<Chart> charts;

  /// Texture coordinates of a place in a chart.
  [[nodiscard]] Eigen::Vector2d uv(std::size_t chart, const Eigen::Vector2d& place_mm) const {
    return (charts[chart].origin_mm + place_mm).cwiseQuotient(size_mm);
  }
  [[nodiscard]] image::RgbImage draw() const;
};

/// Width of the border round a chart in which its picture goes on.
inline constexpr double kGutterMm = 2.5;

}  // namespace hydroprint::sample
