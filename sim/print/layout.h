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

/// Pixels [x0, x1) by [y0, y1) of an image, row 0 on top.
struct Pixels {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  [[nodiscard]] int width() const { return x1 - x0; }
  [[nodiscard]] int height() const { return y1 - y0; }
};

/// One sheet of paper: which part of the film image goes where on it. Places are in the page's
/// frame (Stroke).
struct Sheet {
  Eigen::Vector2d size_mm = Eigen::Vector2d::Zero();  ///< as it is fed
  int column = 0, row = 0;                            ///< among the sheets; row 0 on top
  Pixels window;     ///< of the film image as printed (mirrored where that is asked for)
  Pixels printable;  ///< the part of it that the printer can print; the rest stays white
  Eigen::Vector2d low_mm = Eigen::Vector2d::Zero();  ///< lower left corner of the window
  std::vector<Eigen::Vector2d> film_mm;              ///< the film's edge on this sheet
  std::vector<Stroke> marks;
  std::vector<Text> texts;                  ///< of the marks
  std::vector<std::string> drawn, dropped;  ///< marks, by name
  bool is_text_shortened = false;
};

struct Layout {
  int columns = 1, rows = 1;
  double pitch_mm = 1;
  std::vector<Sheet> sheets;  ///< row by row, from the top
  Warnings warnings;          ///< marks_dropped, text_glyph_missing, text_shortened
};

/// Lays a film image out on paper: at exact scale in the middle of one sheet, turned where the film
/// else would not fit; on several that overlap where it is larger than the paper. Marks stand only
/// where no film is, a millimetre off it, and where the printer can print: registration marks for
/// the sliding bars and at the corners, rulers, an arrow to the film's +y, a line of text; what has
/// no room is left out, with a warning. Text that is too long for the paper is shortened, with a
/// warning.
/// Refuses (kOutOfRange) what check refuses, and a film that takes more than 100 sheets; fails as
/// text::Font::standard() does.
[[nodiscard]] Result<Layout> lay_out(const image::FilmGrid& grid, const film::Outline& outline,
                                     const PageSettings& settings);

}  // namespace hydroprint::print
