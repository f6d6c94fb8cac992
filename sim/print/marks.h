#pragma once

#include <string>
#include <vector>

#include "sim/print/layout.h"
#include "sim/text/font.h"

namespace hydroprint::print {

/// What a sheet's marks are about, in the page's frame.
struct MarkPlan {
  Box printable;
  Box film;    ///< its bounding box, which may reach beyond the sheet
  Box window;  ///< what of the film image is on this sheet
  /// Where neighbouring sheets' windows begin and end within this one.
  std::vector<double> joins_x_mm, joins_y_mm;
  double bar_mm = 0;
  /// The line of text; empty: none. The job name is shortened if there is no room for both.
  std::string job_name, details;
};

/// Draws a sheet's marks (lay_out) where there is room for them.
void add_marks(Sheet& sheet, const MarkPlan& plan, const text::Font& font);

/// A ruler to measure with, ticks every 10 mm, its line on the left or the lower edge of the box
/// that ruler_size_mm gives.
[[nodiscard]] Drawing ruler(const Eigen::Vector2d& low_mm, double length_mm, bool upright);
[[nodiscard]] Eigen::Vector2d ruler_size_mm(double length_mm, bool upright);

/// Adds what is drawn to a page or sheet.
void append(std::vector<Stroke>& strokes, std::vector<Text>& texts, Drawing drawing);

}  // namespace hydroprint::print
