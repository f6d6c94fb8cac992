#pragma once

#include <string>
#include <vector>

#include "sim/print/layout.h"
#include "sim/text/font.h"

namespace hydroprint::print {

/// Input for a sheet's marks, in the page's frame.
struct MarkPlan {
  Box printable;
  Box film;    ///< bounding box of the film, which may extend beyond the sheet
  Box window;  ///< the part of the film image on this sheet
  /// Edges of neighbouring sheets' windows within the window of this sheet.
  std::vector<double> joins_x_mm, joins_y_mm;
  double bar_mm = 0;
  /// The two parts of the line of text; empty: none. The job name is shortened if the line is too
  /// long.
  std::string job_name, details;
};

/// Draws the marks of a sheet (see lay_out()) for which there is space.
void add_marks(Sheet& sheet, const MarkPlan& plan, const text::Font& font);

/// Draws a ruler with ticks every 10 mm. The line is at the left or lower edge of the ruler's box,
/// whose size is ruler_size_mm().
[[nodiscard]] Drawing ruler(const Eigen::Vector2d& low_mm, double length_mm, bool upright);
[[nodiscard]] Eigen::Vector2d ruler_size_mm(double length_mm, bool upright);

/// Appends a drawing to the strokes and texts of a page or sheet.
void append(std::vector<Stroke>& strokes, std::vector<Text>& texts, Drawing drawing);

}  // namespace hydroprint::print
