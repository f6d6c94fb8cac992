#include "sim/print/layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/film/outline.h"
#include "sim/print/marks.h"
#include "sim/print/page_text.h"
#include "tests/sim/print/polygons.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::print {
namespace {

using Eigen::Vector2d;

film::Outline outline_of(const std::string& film) { return film::parse_outline(film).value(); }

PageSettings on(const std::string& paper) {
  PageSettings settings;
  settings.paper_mm = parse_paper(paper).value();
  settings.job_name = "globe 12";
  settings.date = "2025-03-14";
  settings.bar_mm = 40;
  return settings;
}

Layout laid(const std::string& film, const PageSettings& settings, double dpi = 100) {
  const film::Outline outline = outline_of(film);
  const auto layout = lay_out(image::film_grid(outline, 25.4 / dpi), outline, settings);
  if (!layout) throw std::runtime_error(layout.error().message);
  return *layout;
}

const text::Font& font() { return *text::Font::standard().value(); }

/// Points that are about 0.25 mm apart, all over a box.
std::vector<Vector2d> places_in(const Box& box) {
  std::vector<Vector2d> out;
  const Eigen::Vector2i steps = (box.size_mm() / 0.25).cast<int>() + Eigen::Vector2i::Ones();
  for (int i = 0; i <= steps.x(); ++i) {
    for (int k = 0; k <= steps.y(); ++k) {
      const Eigen::Array2d share(static_cast<double>(i) / steps.x(),
                                 static_cast<double>(k) / steps.y());
      out.emplace_back(box.low_mm.array() + share * box.size_mm().array());
    }
  }
  return out;
}

bool overlap(const Box& a, const Box& b) {
  return (a.low_mm.array() < b.high_mm.array()).all() &&
         (b.low_mm.array() < a.high_mm.array()).all();
}

/// Expects that all text is within the printable area, at least 1 mm away from the film, and does
/// not overlap other text or strokes.
void expect_text_off_film(const Sheet& sheet, double margin_mm) {
  for (std::size_t i = 0; i < sheet.texts.size(); ++i) {
    const Box box = text_box(font(), sheet.texts[i]);
    SCOPED_TRACE(sheet.texts[i].text);
    for (const Vector2d& p : places_in(box)) {
      ASSERT_GE(p.minCoeff(), margin_mm);
      ASSERT_GE((sheet.size_mm - p).minCoeff(), margin_mm);
      ASSERT_GE(distance_to_polygon(sheet.film_mm, p), 0.999) << p.transpose();
    }
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_FALSE(overlap(box, text_box(font(), sheet.texts[k]))) << sheet.texts[k].text;
    }
    for (const Stroke& stroke : sheet.marks) {
      for (std::size_t k = 0; k + 1 < stroke.points_mm.size(); ++k) {
        const Vector2d a = stroke.points_mm[k], b = stroke.points_mm[k + 1];
        for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
          const Vector2d p = a + t * (b - a);
          EXPECT_FALSE(overlap(box, {p, p})) << p.transpose();
        }
      }
    }
  }
}

/// Expects that all text and all strokes are within the printable area and at least 1 mm away from
/// the film. Strokes are checked at points 0.25 mm apart, with the width of their pens.
void expect_marks_off_film(const Layout& layout, double margin_mm) {
  for (const Sheet& sheet : layout.sheets) {
    expect_text_off_film(sheet, margin_mm);
    for (const Stroke& stroke : sheet.marks) {
      const double half = stroke.width_mm / 2;
      for (std::size_t i = 0; i + 1 < stroke.points_mm.size(); ++i) {
        const Vector2d along = stroke.points_mm[i + 1] - stroke.points_mm[i];
        const int steps = static_cast<int>(along.norm() / 0.25) + 1;
        for (int k = 0; k <= steps; ++k) {
          const Vector2d p = stroke.points_mm[i] + along * k / steps;
          ASSERT_GE(p.minCoeff() - half, margin_mm);
          ASSERT_GE((sheet.size_mm - p).minCoeff() - half, margin_mm);
          ASSERT_GE(distance_to_polygon(sheet.film_mm, p) - half, 0.999) << p.transpose();
        }
      }
    }
  }
}

TEST(Layout, AFilmOfThePapersSizeWarnsOfDroppedMarks) {
  const Layout layout = laid("A4", on("A4"));
  ASSERT_EQ(layout.sheets.size(), 1U);
  EXPECT_TRUE(layout.sheets[0].marks.empty());
  EXPECT_EQ(layout.sheets[0].dropped.size(), 6U);
  ASSERT_EQ(layout.warnings.size(), 1U);
  EXPECT_EQ(layout.warnings[0].code, WarningCode::MARKS_DROPPED);
  EXPECT_NE(layout.warnings[0].message.find("upright ruler"), std::string::npos);
}

TEST(Layout, WithRoomAllMarksAreDrawnWithoutWarnings) {
  const Layout layout = laid("A4", on("A3"));
  ASSERT_EQ(layout.sheets.size(), 1U);
  EXPECT_EQ(layout.sheets[0].drawn,
            (std::vector<std::string>{"registration marks", "corner marks", "ruler",
                                      "upright ruler", "arrow", "text"}));
  EXPECT_TRUE(layout.warnings.empty());
  EXPECT_EQ(layout.sheets[0].size_mm, Vector2d(297, 420));
}

TEST(Layout, MarksNeverLieOnFilm) {
  const testing::TemporaryFolder folder;
  const std::string polygon =
      folder.write("l.json", "[[0,0],[150,0],[150,60],[70,60],[70,190],[0,190]]");
  const std::vector<std::string> films = {"A4", "circle:90", "200x120", "120x200",
                                          "polygon:" + polygon};
  for (const std::string& film : films) {
    for (const std::string paper : {"A3", "A4", "letter", "250x320", "400x310"}) {
      for (const auto& [margin_mm, mirror] : {std::pair{0.0, true}, {4.2, false}}) {
        PageSettings settings = on(paper);
        settings.printer_margin_mm = margin_mm;
        settings.mirror = mirror;
        SCOPED_TRACE(film + " on " + paper);
        expect_marks_off_film(laid(film, settings), margin_mm);
      }
    }
  }
}

/// The text beside the film; empty if there is none.
std::string text_of(const Sheet& sheet) {
  for (const Text& text : sheet.texts) {
    if (text.text.find("2025-03-14") != std::string::npos) return text.text;
  }
  return {};
}

TEST(Layout, TheJobNameStandsUnchangedBesideTheFilm) {
  PageSettings settings = on("A3");
  settings.job_name = "Mug 7 - Ärztin GROSS & klein, №3";
  const Layout layout = laid("A4", settings);
  EXPECT_EQ(text_of(layout.sheets[0]), settings.job_name + "  2025-03-14");
  EXPECT_TRUE(layout.warnings.empty());
}

TEST(Layout, LongJobNamesAreShortenedBeforeDateAndSheetNumber) {
  PageSettings settings = on("A4");
  for (int i = 0; i < 25; ++i) settings.job_name += " ÅÄÖ gjpqy";
  for (const std::string film : {"100x160", "circle:60", "500x200"}) {
    SCOPED_TRACE(film);
    const Layout layout = laid(film, settings);
    expect_marks_off_film(layout, 0);
    for (const Sheet& sheet : layout.sheets) {
      const std::string text = text_of(sheet);
      ASSERT_TRUE(sheet.is_text_shortened);
      EXPECT_TRUE(text.starts_with("globe 12 ÅÄÖ")) << text;
      EXPECT_NE(text.find("…  2025-03-14"), std::string::npos) << text;
    }
    EXPECT_EQ(layout.warnings.at(0).code, WarningCode::TEXT_SHORTENED);
  }
}

TEST(Layout, TextOnANarrowStripIsShortenedOrLeftOut) {
  PageSettings settings = on("60x60");
  settings.job_name = "Mug 7 - Ärztin GROSS & klein, №3";
  for (const std::string film : {"20x20", "40x40", "50x20", "58x58", "60x60"}) {
    const Layout layout = laid(film, settings);
    expect_marks_off_film(layout, 0);
    const Sheet& sheet = layout.sheets[0];
    const bool is_drawn = std::count(sheet.drawn.begin(), sheet.drawn.end(), "text") == 1;
    EXPECT_EQ(is_drawn, std::count(sheet.dropped.begin(), sheet.dropped.end(), "text") == 0);
  }
}

TEST(Layout, CharactersThatTheFontLacksAreWarnedOfOnce) {
  PageSettings settings = on("A4");
  settings.job_name = "Mug 漢字 \U0001F9D9";
  const Layout layout = laid("500x200", settings);
  ASSERT_GT(layout.sheets.size(), 1U);
  ASSERT_EQ(layout.warnings.size(), 1U);
  EXPECT_EQ(layout.warnings[0].code, WarningCode::TEXT_GLYPH_MISSING);
  EXPECT_NE(layout.warnings[0].message.find("'漢' (U+6F22), '字' (U+5B57)"), std::string::npos);
}

TEST(Layout, TheRulersNumbersStandInItsBox) {
  for (const bool upright : {false, true}) {
    for (const double length_mm : {50.0, 200.0}) {
      const Vector2d size = ruler_size_mm(length_mm, upright);
      for (const Text& text : ruler(Vector2d::Zero(), length_mm, upright).texts) {
        const Box box = text_box(font(), text);
        EXPECT_GE(box.low_mm.minCoeff(), 0) << text.text;
        EXPECT_GE((size - box.high_mm).minCoeff(), 0) << text.text;
      }
    }
  }
}

TEST(Layout, RegistrationMarksPointAtTheMiddlesAndEndsOfTheBars) {
  const Layout layout = laid("100x160", on("A4"));
  const Sheet& sheet = layout.sheets[0];
  const Vector2d middle = sheet.size_mm / 2;
  int found = 0;
  for (const Stroke& stroke : sheet.marks) {
    if (stroke.points_mm.size() != 2) continue;
    const Vector2d from = stroke.points_mm[0] - middle, to = stroke.points_mm[1] - middle;
    for (const double along : {-20.0, 0.0, 20.0}) {
      for (const double side : {-1.0, 1.0}) {
        found += (from - Vector2d(along, side * 82)).norm() < 1e-9 && to.x() == from.x();
        found += (from - Vector2d(side * 52, along)).norm() < 1e-9 && to.y() == from.y();
      }
    }
  }
  EXPECT_EQ(found, 12);
}

TEST(Layout, PaperIsRotatedIfTheFilmWouldNotFitOtherwise) {
  EXPECT_EQ(laid("280x100", on("A4")).sheets[0].size_mm, Vector2d(297, 210));
  EXPECT_EQ(laid("100x280", on("A4")).sheets[0].size_mm, Vector2d(210, 297));
}

TEST(Layout, SheetsCoverALargerFilmAndOverlapAsRequested) {
  for (const double overlap_mm : {0.0, 7.3, 15.0}) {
    for (const std::string film : {"A3", "500x200", "211x297", "900x1200"}) {
      PageSettings settings = on("A4");
      settings.overlap_mm = overlap_mm;
      settings.printer_margin_mm = 3;
      SCOPED_TRACE(film);
      const Layout layout = laid(film, settings);
      ASSERT_EQ(layout.sheets.size(), static_cast<std::size_t>(layout.columns * layout.rows));
      ASSERT_GT(layout.sheets.size(), 1U);
      expect_marks_off_film(layout, 3);
      const image::FilmGrid grid = image::film_grid(outline_of(film), layout.pitch_mm);
      for (const Sheet& sheet : layout.sheets) {
        const Pixels& own = sheet.window;
        EXPECT_EQ(own.x0 == 0, sheet.column == 0);
        EXPECT_EQ(own.x1 == grid.columns, sheet.column == layout.columns - 1);
        EXPECT_EQ(own.y0 == 0, sheet.row == 0);
        EXPECT_EQ(own.y1 == grid.rows, sheet.row == layout.rows - 1);
        // The whole window is printed.
        EXPECT_EQ(sheet.printable.width(), own.width());
        EXPECT_EQ(sheet.printable.height(), own.height());
        if (sheet.column > 0) {
          const Pixels& left = (&sheet)[-1].window;
          EXPECT_GE((left.x1 - own.x0) * layout.pitch_mm, overlap_mm);
        }
        if (sheet.row > 0) {
          const Pixels& above = (&sheet)[-layout.columns].window;
          EXPECT_GE((above.y1 - own.y0) * layout.pitch_mm, overlap_mm);
        }
      }
    }
  }
}

TEST(Layout, AMirroredFilmLiesMirroredOnThePage) {
  const testing::TemporaryFolder folder;
  const std::string corner = "polygon:" + folder.write("c.json", "[[0,0],[100,0],[0,50]]").string();
  PageSettings settings = on("A4");
  const auto straight = laid(corner, settings).sheets[0].film_mm;
  settings.mirror = true;
  const auto mirrored = laid(corner, settings).sheets[0].film_mm;
  ASSERT_EQ(straight.size(), mirrored.size());
  for (std::size_t i = 0; i < straight.size(); ++i) {
    EXPECT_NEAR(straight[i].x() + mirrored[i].x(), 210, 1e-9);
    EXPECT_NEAR(straight[i].y(), mirrored[i].y(), 1e-9);
  }
}

TEST(Layout, RefusesSettingsOutOfRange) {
  const film::Outline outline = outline_of("900x1200");
  const auto refused = [&](PageSettings settings) {
    const auto layout = lay_out(image::film_grid(outline, 0.254), outline, settings);
    return layout ? "" : layout.error().message;
  };
  PageSettings settings = on("A4");
  settings.printer_margin_mm = 96;
  EXPECT_NE(refused(settings).find("printer margin: "), std::string::npos);
  settings = on("A4");
  settings.overlap_mm = -1;
  EXPECT_NE(refused(settings).find("overlap: "), std::string::npos);
  settings = on("50x50");
  EXPECT_NE(refused(settings).find("paper: too small"), std::string::npos);
  EXPECT_FALSE(parse_paper("circle:100"));
  EXPECT_FALSE(parse_paper("A5x"));
  EXPECT_EQ(parse_paper("5x5").error().code, Code::kOutOfRange);
}

}  // namespace
}  // namespace hydroprint::print
