#pragma once

#include <string>
#include <vector>

#include "sim/print/layout.h"
#include "sim/text/font.h"

namespace hydroprint::print {

/// Input for a sheet's marks, in the page's frame.
struct MarkPlan {
  Box printable;
  Box film;    ///< its bounding box, which may reach beyond the sheet
  Box window;  ///< the part of the film image on this sheet
  /// Edges of neighbouring sheets' windows within this one.
  std::vector<double> joins_x_mm, joins_y_mm;
  double bar_mm = 0;
  /// The line of text; empty: none. The job name is shortened if there is no room for both.
  std::string job_name, details;
};

/// Draws those marks of a sheet (lay_out) for which there is room.
void add_marks(Sheet& sheet, const MarkPlan& plan, const text::Font& font);

/// A ruler for measuring, with ticks every 10 mm. Its line is on the left or the lower edge of its
/// box, whose size is ruler_size_mm().
[[nodiscard]] Drawing ruler(const Eigen::Vector2d& low_mm, double length_mm, bool upright);
[[nodiscard]] Eigen::Vector2d ruler_size_mm(double length_mm, bool upright);

/// Adds what is drawn to a page or sheet.
void append(std::vector<Stroke>& strokes, std::vector<Text>& texts, Drawing drawing);

}  // namespace hydroprint::print
