#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/base/result.h"
#include "sim/film/outline.h"
#include "sim/image/film/film_image.h"
#include "sim/print/free_space.h"
#include "sim/print/page.h"
#include "sim/print/settings.h"

namespace hydroprint::print {

/// Pixels [x0, x1) by [y0, y1) of an image, row 0 at the top.
struct Pixels {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  [[nodiscard]] int width() const { return x1 - x0; }
  [[nodiscard]] int height() const { return y1 - y0; }
};

/// One sheet of paper with its part of the film image. Coordinates are in the page's frame
/// (see Stroke).
struct Sheet {
  /// Size of the paper, in the orientation in which the printer feeds it.
  Eigen::Vector2d size_mm = Eigen::Vector2d::Zero();
  int column = 0, row = 0;  ///< position among the sheets; row 0 at the top
  Pixels window;            ///< part of the printed film image (mirrored if requested)
  Pixels printable;  ///< the part of the window that the printer can print; the rest stays white
  Eigen::Vector2d low_mm = Eigen::Vector2d::Zero();  ///< lower left corner of the window
  std::vector<Eigen::Vector2d> film_mm;              ///< the film's edge on this sheet
  std::vector<Stroke> marks;
  std::vector<Text> texts;                  ///< texts of the marks
  std::vector<std::string> drawn, dropped;  ///< names of marks
  bool is_text_shortened = false;
};

struct Layout {
  int columns = 1, rows = 1;
  double pitch_mm = 1;
  std::vector<Sheet> sheets;  ///< row by row, from the top
  Warnings warnings;          ///< MARKS_DROPPED, TEXT_GLYPH_MISSING, TEXT_SHORTENED
};

/// Lays out a film image on paper at exact scale. The image is in the middle of one sheet, rotated
/// if it does not fit otherwise, or on several overlapping sheets if it is larger than the paper.
/// Marks are drawn only outside the film, at least a millimetre away from it, and where the printer
/// can print. They are registration marks for the sliding bars and at the corners, rulers, an arrow
/// to the film's +y and a line of text. Marks without space are dropped, with a warning. Returns
/// the errors of check(), and kOutOfRange for a film that needs more than 100 sheets.
[[nodiscard]] Result<Layout> lay_out(const image::FilmGrid& grid, const film::Outline& outline,
                                     const PageSettings& settings);

}  // namespace hydroprint::print
