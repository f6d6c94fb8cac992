#include "sim/print/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/base/check.h"
#include "sim/print/marks.h"
#include "sim/print/page_text.h"
#include "sim/text/font.h"

namespace hydroprint::print {
namespace {

using Eigen::Vector2d;

/// Space for marks along the edges of sheets that contain only a part of the film.
constexpr double kJoinRoom_mm = 9;
constexpr int kMostSheets = 100;
constexpr double kRounding_mm = 1e-6;

Vector2d turned(const Vector2d& size_mm) { return {size_mm.y(), size_mm.x()}; }

/// A window along one side of the film image: pixels [first, end).
struct Cut {
  int first = 0, end = 0;
};

/// Returns the smallest number of equal windows of at most `most_px` that cover `size_px` and
/// overlap by at least `overlap_px`; empty if there would be too many.
std::vector<Cut> cuts(int size_px, int most_px, int overlap_px) {
  HP_CHECK(size_px > 0);
  HP_CHECK(overlap_px >= 0);
  if (size_px <= most_px) return {{0, size_px}};
  if (most_px <= overlap_px) return {};
  const int count = 1 + (size_px - most_px + most_px - overlap_px - 1) / (most_px - overlap_px);
  if (count > kMostSheets) return {};
  const int width = (size_px + (count - 1) * overlap_px + count - 1) / count;
  std::vector<Cut> out;
  for (int i = 0; i < count; ++i) {
    const int first = static_cast<int>(static_cast<long>(i) * (size_px - width) / (count - 1));
    out.push_back({first, first + width});
  }
  return out;
}

struct Cuts {
  Vector2d sheet_mm = Vector2d::Zero();
  std::vector<Cut> across, down;

  [[nodiscard]] std::size_t sheets() const { return across.size() * down.size(); }
};

/// Cuts the film image for paper in this orientation; no sheets if that is impossible.
Cuts cuts_for(const image::FilmGrid& grid, const Vector2d& film_mm, const Vector2d& sheet_mm,
              const PageSettings& settings) {
  if ((sheet_mm - film_mm).minCoeff() >= -kRounding_mm) {
    return {sheet_mm, {{0, grid.columns}}, {{0, grid.rows}}};
  }
  const double edge_mm = settings.printer_margin_mm + kJoinRoom_mm;
  const auto fitting = [&](double side_mm) {
    return static_cast<int>((side_mm - 2 * edge_mm) / grid.pitch_mm);
  };
  const int overlap_px = static_cast<int>(std::ceil(settings.overlap_mm / grid.pitch_mm));
  return {sheet_mm, cuts(grid.columns, fitting(sheet_mm.x()), overlap_px),
          cuts(grid.rows, fitting(sheet_mm.y()), overlap_px)};
}

Result<Cuts> best_cuts(const image::FilmGrid& grid, const film::Outline& outline,
                       const PageSettings& settings) {
  const Vector2d film_mm = outline.size_mm();
  const Cuts lying = cuts_for(grid, film_mm, settings.paper_mm, settings);
  const Cuts other = cuts_for(grid, film_mm, turned(settings.paper_mm), settings);
  const bool use_other =
      other.sheets() > 0 && (lying.sheets() == 0 || other.sheets() < lying.sheets());
  const Cuts& best = use_other ? other : lying;
  if (best.sheets() > 0 && best.sheets() <= kMostSheets) return best;
  return fail(Code::kOutOfRange,
              fmt::format("paper: too small for the film {}, which would take more than {} sheets. "
                          "Use larger paper, or less margin and overlap",
                          outline.name, kMostSheets));
}

/// Returns the pixels of a window within the area that the printer can print.
Pixels printable_pixels(const Sheet& sheet, const Box& printable, double pitch_mm) {
  const Vector2d high_mm =
      sheet.low_mm + Vector2d(sheet.window.width(), sheet.window.height()) * pitch_mm;
  const auto inside = [&](double beyond_mm, int most) {
    const double pixels = std::ceil(beyond_mm / pitch_mm - kRounding_mm);
    return std::clamp(static_cast<int>(pixels), 0, most);
  };
  // The size of an image is rounded to whole pixels, so half a pixel beyond the edge is ignored.
  const Vector2d slack = Vector2d::Constant(pitch_mm / 2 + kRounding_mm);
  const Vector2d low = printable.low_mm - sheet.low_mm - slack;
  const Vector2d high = high_mm - printable.high_mm - slack;
  Pixels out = sheet.window;
  out.x0 += inside(low.x(), sheet.window.width());
  out.x1 = std::max(out.x0, out.x1 - inside(high.x(), sheet.window.width()));
  out.y0 += inside(high.y(), sheet.window.height());
  out.y1 = std::max(out.y0, out.y1 - inside(low.y(), sheet.window.height()));
  return out;
}

/// Transforms the film frame to a sheet's page.
class ToPage {
 public:
  ToPage(const image::FilmGrid& grid, const Sheet& sheet, bool mirror)
      : grid_(grid), sheet_(sheet), mirror_(mirror) {}

  [[nodiscard]] Vector2d operator()(const Vector2d& film_mm) const {
    Vector2d cell = grid_.cell(film_mm);
    if (mirror_) cell.x() = grid_.columns - cell.x();
    return from_cell(cell);
  }
  /// Returns the point on the page for a position in the image as printed (pixels, y down).
  [[nodiscard]] Vector2d from_cell(const Vector2d& cell) const {
    return sheet_.low_mm +
           grid_.pitch_mm * Vector2d(cell.x() - sheet_.window.x0, sheet_.window.y1 - cell.y());
  }

 private:
  const image::FilmGrid& grid_;
  const Sheet& sheet_;
  bool mirror_;
};

Box box_between(const Vector2d& a, const Vector2d& b) { return {a.cwiseMin(b), a.cwiseMax(b)}; }

/// Returns the film's outline on the sheet, or the sheet's window if the film is on several sheets.
std::vector<Vector2d> film_on(const Sheet& sheet, const film::Outline& outline,
                              const ToPage& to_page, bool is_part, double pitch_mm) {
  if (is_part) {
    const Vector2d size = Vector2d(sheet.window.width(), sheet.window.height()) * pitch_mm;
    const Vector2d& low = sheet.low_mm;
    return {low, {low.x() + size.x(), low.y()}, low + size, {low.x(), low.y() + size.y()}};
  }
  std::vector<Vector2d> out;
  for (const Vector2d& corner : outline.polygon) out.push_back(to_page(corner));
  return out;
}

/// Returns the edges of the neighbouring windows that lie inside window `own`.
std::vector<double> joins(const std::vector<Cut>& cuts, std::size_t own) {
  HP_CHECK(own < cuts.size());
  std::vector<double> out;
  const auto add = [&](int edge) {
    if (edge > cuts[own].first && edge < cuts[own].end) out.push_back(edge);
  };
  if (own > 0) add(cuts[own - 1].end);
  if (own + 1 < cuts.size()) add(cuts[own + 1].first);
  return out;
}

/// Returns the text that follows the job name on a sheet.
std::string details(const PageSettings& settings, std::size_t number, std::size_t sheets) {
  std::string out;
  const auto add = [&out](const std::string& text) {
    if (!text.empty()) out += (out.empty() ? "" : "  ") + text;
  };
  add(settings.date);
  if (sheets > 1) add(fmt::format("sheet {} of {}", number, sheets));
  if (settings.mirror) add("mirrored: ink side down");
  return out;
}

class LayOut {
 public:
  /// @param font  nullptr: no marks
  LayOut(const image::FilmGrid& grid, const film::Outline& outline, const PageSettings& settings,
         const Cuts& cuts, const text::Font* font)
      : grid_(grid), outline_(outline), settings_(settings), cuts_(cuts), font_(font) {}

  [[nodiscard]] Sheet sheet(std::size_t row, std::size_t column) const {
    Sheet out;
    out.size_mm = cuts_.sheet_mm;
    out.column = static_cast<int>(column);
    out.row = static_cast<int>(row);
    out.window = {cuts_.across[column].first, cuts_.down[row].first, cuts_.across[column].end,
                  cuts_.down[row].end};
    const Vector2d size = Vector2d(out.window.width(), out.window.height()) * grid_.pitch_mm;
    out.low_mm = (out.size_mm - size) / 2;
    const Vector2d margin = Vector2d::Constant(settings_.printer_margin_mm);
    const Box printable{margin, out.size_mm - margin};
    out.printable = printable_pixels(out, printable, grid_.pitch_mm);
    const ToPage to_page(grid_, out, settings_.mirror);
    out.film_mm = film_on(out, outline_, to_page, cuts_.sheets() > 1, grid_.pitch_mm);
    if (font_ != nullptr) add_marks(out, plan(out, printable, to_page), *font_);
    return out;
  }

 private:
  [[nodiscard]] MarkPlan plan(const Sheet& sheet, const Box& printable,
                              const ToPage& to_page) const {
    MarkPlan out;
    out.printable = printable;
    out.film = box_between(to_page(outline_.min_mm), to_page(outline_.max_mm));
    const auto column = static_cast<std::size_t>(sheet.column);
    const auto row = static_cast<std::size_t>(sheet.row);
    out.window = box_between(to_page.from_cell(Vector2d(sheet.window.x0, sheet.window.y0)),
                             to_page.from_cell(Vector2d(sheet.window.x1, sheet.window.y1)));
    if (cuts_.sheets() == 1) out.window = out.film;
    for (const double x : joins(cuts_.across, column)) {
      out.joins_x_mm.push_back(to_page.from_cell({x, 0}).x());
    }
    for (const double y : joins(cuts_.down, row)) {
      out.joins_y_mm.push_back(to_page.from_cell({0, y}).y());
    }
    out.bar_mm = settings_.bar_mm;
    out.job_name = settings_.job_name;
    out.details = details(settings_, row * cuts_.across.size() + column + 1, cuts_.sheets());
    return out;
  }

  const image::FilmGrid& grid_;
  const film::Outline& outline_;
  const PageSettings& settings_;
  const Cuts& cuts_;
  const text::Font* font_;
};

void warn_of_marks(const Sheet& sheet, std::size_t number, Warnings& warnings) {
  const Place where = {OnSheet{static_cast<int>(number)}};
  if (sheet.is_text_shortened) warn_of_shortened_text(where, warnings);
  if (sheet.dropped.empty()) return;

  warnings.push_back(
      {WarningCode::MARKS_DROPPED,
       fmt::format(
           "there is not enough room beside the film, so these are left out: {}. Use larger paper",
           fmt::join(sheet.dropped, ", ")),
       where});
}

std::vector<Text> texts_of(const std::vector<Sheet>& sheets) {
  std::vector<Text> out;
  for (const Sheet& sheet : sheets) {
    out.insert(out.end(), sheet.texts.begin(), sheet.texts.end());
  }
  return out;
}

}  // namespace

Result<Layout> lay_out(const image::FilmGrid& grid, const film::Outline& outline,
                       const PageSettings& settings) {
  HP_RETURN_IF_ERROR(check(settings));
  HP_ASSIGN_OR_RETURN(const Cuts cuts, best_cuts(grid, outline, settings));
  Layout out;
  out.columns = static_cast<int>(cuts.across.size());
  out.rows = static_cast<int>(cuts.down.size());
  out.pitch_mm = grid.pitch_mm;
  const text::Font* font = nullptr;
  if (settings.marks) {
    HP_ASSIGN_OR_RETURN(font, text::Font::standard());
  }
  const LayOut lay(grid, outline, settings, cuts, font);
  for (std::size_t row = 0; row < cuts.down.size(); ++row) {
    for (std::size_t column = 0; column < cuts.across.size(); ++column) {
      out.sheets.push_back(lay.sheet(row, column));
      warn_of_marks(out.sheets.back(), out.sheets.size(), out.warnings);
    }
  }
  if (font != nullptr) {
    warn_of_missing_glyphs(*font, texts_of(out.sheets), {OfItem{"text beside the film"}},
                           out.warnings);
  }
  return out;
}

}  // namespace hydroprint::print
