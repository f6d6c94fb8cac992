#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "sim/sample/painting.h"

namespace hydroprint::sample {

/// A rectangle of the texture, measured in mm on the surface: its position in the sheet and its
/// picture.
struct Chart {
  Eigen::Vector2d origin_mm;  ///< lower left corner, in the sheet
  Eigen::Vector2d size_mm;
  std::function<Colour(double x_mm, double y_mm)> colour_at;  ///< colour at a position in the chart
};

/// The charts, arranged side by side on one texture. Their pictures continue into gutters around
/// them, so that texture filters do not mix in other colours.
struct Sheet {
  Eigen::Vector2d size_mm;
  double px_per_mm = 8;
  std::vector<Chart> charts;

  /// Returns the texture coordinates of a position in a chart.
  [[nodiscard]] Eigen::Vector2d uv(std::size_t chart, const Eigen::Vector2d& place_mm) const {
    return (charts[chart].origin_mm + place_mm).cwiseQuotient(size_mm);
  }
  [[nodiscard]] image::RgbImage draw() const;
};

/// Width of the gutter around a chart.
inline constexpr double kGutterMm = 2.5;

}  // namespace hydroprint::sample
