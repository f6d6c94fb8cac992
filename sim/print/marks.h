#pragma once

#include <string>
#include <vector>

#include "sim/print/layout.h"

namespace hydroprint::print {

/// What a sheet's marks are about, in the page's frame.
struct MarkPlan {
  Box printable;
  Box film;    ///< its bounding box, which may reach beyond the sheet
  Box window;  ///< what of the film image is on this sheet
  /// Where neighbouring sheets' windows begin and end within this one.
  std::vector<double> joins_x_mm, joins_y_mm;
  double bar_mm = 0;
  std::string text;  ///< empty: none
};

/// Draws a sheet's marks (lay_out) where there is room for them.
void add_marks(Sheet& sheet, const MarkPlan& plan);

/// Text as strokes, its baseline beginning at a place; `size_mm` is the height of a lower-case x.
[[nodiscard]] std::vector<Stroke> lettered(const std::string& text, const Eigen::Vector2d& at_mm,
                                           double size_mm);
/// How wide that is.
[[nodiscard]] double text_width_mm(const std::string& text, double size_mm);

/// A ruler to measure with, ticks every 10 mm, its line on the left or the lower edge of the box
/// that ruler_size_mm gives.
[[nodiscard]] std::vector<Stroke> ruler(const Eigen::Vector2d& low_mm, double length_mm,
                                        bool upright);
[[nodiscard]] Eigen::Vector2d ruler_size_mm(double length_mm, bool upright);

}  // namespace hydroprint::print
