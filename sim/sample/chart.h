#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "sim/sample/painting.h"

namespace hydroprint::sample {

/// A rectangle of the texture, in mm of surface: its place in the sheet and its picture.
struct Chart {
  Eigen::Vector2d origin_mm;  ///< lower left corner, in the sheet
  Eigen::Vector2d size_mm;
  std::function<Colour(double x_mm, double y_mm)> colour_at;  ///< colour at a place in the chart
};

/// The charts side by side on one texture. Their pictures continue into gutters around them, so
/// that texture filters do not mix in other colours.
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

/// Width of the gutter around a chart.
inline constexpr double kGutterMm = 2.5;

}  // namespace hydroprint::sample
