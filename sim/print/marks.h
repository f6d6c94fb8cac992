#pragma once

#include <string>
#include <vector>

#include "sim/print/layout.h"

namespace hydroprint::print {

/// Input for a sheet's marks, in the page's frame.
struct MarkPlan {
  Box printable;
  Box film;    ///< its bounding box, which may reach beyond the sheet
  Box window;  ///< the part of the film image on this sheet
  /// Edges of neighbouring sheets' windows within this one.
  std::vector<double> joins_x_mm, joins_y_mm;
  double bar_mm = 0;
  std::string text;  ///< empty: none
};

/// Draws those marks of a sheet (lay_out) for which there is room.
void add_marks(Sheet& sheet, const MarkPlan& plan);

/// Text as strokes; `at_mm` is the start of its baseline, `size_mm` the height of a lower-case x.
[[nodiscard]] std::vector<Stroke> lettered(const std::string& text, const Eigen::Vector2d& at_mm,
                                           double size_mm);
/// Width of such a text.
[[nodiscard]] double text_width_mm(const std::string& text, double size_mm);

/// A ruler for measuring, with ticks every 10 mm. Its line is on the left or the lower edge of its
/// box, whose size is ruler_size_mm().
[[nodiscard]] std::vector<Stroke> ruler(const Eigen::Vector2d& low_mm, double length_mm,
                                        bool upright);
[[nodiscard]] Eigen::Vector2d ruler_size_mm(double length_mm, bool upright);

}  // namespace hydroprint::print
