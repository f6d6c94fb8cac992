// The text on pages. Other programs read the files of the program.

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>

#include "sim/image/io/image_file.h"
#include "tests/sim/print/raster_files.h"
#include "tests/support/paths.h"
#include "tests/support/process.h"

namespace hydroprint::print {
namespace {

using testing::Ended;
using Arguments = std::vector<std::string>;

const std::string kTitle = "Mug 7 - Ärztin GROSS & klein, №3";

class PageText : public ::testing::Test {
 protected:
  void SetUp() override {
    // 105 x 148.5 mm at 150 dpi.
    const image::RgbImage blank{620, 877, std::vector<std::uint8_t>(3U * 620 * 877, 255)};
    ASSERT_TRUE(image::write_png(path("film.png"), blank, 150));
    folder.write("pyramid.obj",
                 "v 0 0 0\nv -30 -20 50\nv 30 -20 50\nv 30 20 50\nv -30 20 50\n"
                 "f 1 3 2\nf 1 4 3\nf 1 5 4\nf 1 2 5\nf 2 3 4 5\n");
  }
  [[nodiscard]] std::string path(const std::string& name) const { return folder.path() / name; }
  [[nodiscard]] Arguments print_image(const Arguments& more) const {
    Arguments all = {testing::program_path("hydroprint-worker"),
                     "print-image",
                     "--film-image",
                     path("film.png"),
                     "--film",
                     "105x148.5",
                     "--formats",
                     "pdf",
                     "--out",
                     path("out")};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  /// Prints with a job name and returns the exit status and output of the program.
  Ended print(const std::string& job_name, const Arguments& more = {}) const {
    Arguments all = print_image({"--job-name", job_name});
    all.insert(all.end(), more.begin(), more.end());
    Ended ended = testing::run(all);
    EXPECT_EQ(ended.status, 0) << ended.err;
    return ended;
  }
  [[nodiscard]] std::string text_of(const std::string& pdf) const {
    const Ended ended = testing::run({"/usr/bin/pdftotext", "-enc", "UTF-8", path(pdf), "-"});
    EXPECT_EQ(ended.status, 0) << ended.err;
    EXPECT_EQ(ended.err, "");
    return ended.out;
  }
  [[nodiscard]] nlohmann::json warnings() const {
    return nlohmann::json::parse(bytes_of(path("out/report.json")))["run"]["warnings"];
  }

  testing::TemporaryFolder folder;
};

TEST_F(PageText, TheTitleComesOutOfThePdfAsItWasGiven) {
  const Ended ended = print(kTitle, {"--date", "2025-03-14"});
  EXPECT_EQ(ended.err, "");
  EXPECT_TRUE(warnings().empty());
  const std::string text = text_of("out/print.pdf");
  EXPECT_NE(text.find(kTitle), std::string::npos) << text;
  EXPECT_NE(text.find("2025-03-14"), std::string::npos) << text;
  EXPECT_NE(text.find("top +y"), std::string::npos) << text;
  EXPECT_NE(text.find("200 mm"), std::string::npos) << text;
  const Ended info = testing::run({"/usr/bin/pdfinfo", path("out/print.pdf")});
  EXPECT_NE(info.out.find("Title:           " + kTitle + "\n"), std::string::npos) << info.out;
}

TEST_F(PageText, TheTitleOfASpecFileAndOfATemplateIsTheSame) {
  const std::string spec = folder.write(
      "spec.json", R"({"film_image":{"name":"film.png"},"film":"105x148.5","formats":["pdf"],)"
                   R"("job_name":"Mug 7 - \u00c4rztin GROSS & klein, №3"})");
  const Ended printed = testing::run({testing::program_path("hydroprint-worker"), "print-image",
                                      "--spec", spec, "--out", path("out")});
  ASSERT_EQ(printed.status, 0) << printed.err;
  EXPECT_NE(text_of("out/print.pdf").find(kTitle), std::string::npos);
  const Ended placed =
      testing::run({testing::program_path("hydroprint-worker"), "template", "--mesh",
                    path("pyramid.obj"), "--job-name", kTitle, "--out", path("placed")});
  ASSERT_EQ(placed.status, 0) << placed.err;
  const std::string text = text_of("placed/placement.pdf");
  EXPECT_NE(text.find(kTitle), std::string::npos) << text;
  EXPECT_NE(text.find("placement, seen from above"), std::string::npos) << text;
}

TEST_F(PageText, TheFontIsEmbeddedAsASubsetWithUnicode) {
  print(kTitle);
  const Ended fonts = testing::run({"/usr/bin/pdffonts", path("out/print.pdf")});
  EXPECT_TRUE(std::regex_search(
      fonts.out, std::regex("[A-Z]{6}\\+DejaVuSans +CID TrueType +Identity-H +yes yes yes ")))
      << fonts.out;
  EXPECT_EQ(std::count(fonts.out.begin(), fonts.out.end(), '\n'), 3) << fonts.out;
  EXPECT_LT(std::filesystem::file_size(path("out/print.pdf")), 40000U);
}

TEST_F(PageText, CapitalAndSmallLettersArePrintedDifferently) {
  print("MUG");
  const Raster capital = drawn_by_poppler(path("out/print.pdf"), 150);
  print("mug");
  const Raster small = drawn_by_poppler(path("out/print.pdf"), 150);
  ASSERT_EQ(capital.samples.size(), small.samples.size());
  EXPECT_NE(capital.samples, small.samples);
}

/// A word of a page and its box as found by pdftotext, in points from the upper left corner.
struct Word {
  std::string text;
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

std::vector<Word> words_of(const std::string& pdf) {
  const Ended ended = testing::run({"/usr/bin/pdftotext", "-bbox", "-l", "1", pdf, "-"});
  const std::regex word(
      R"re(<word xMin="([^"]+)" yMin="([^"]+)" xMax="([^"]+)" yMax="([^"]+)">([^<]*)<)re");
  std::vector<Word> out;
  for (std::sregex_iterator at(ended.out.begin(), ended.out.end(), word), end; at != end; ++at) {
    out.push_back({(*at)[5], std::stod((*at)[1]), std::stod((*at)[2]), std::stod((*at)[3]),
                   std::stod((*at)[4])});
  }
  return out;
}

/// Share of a word's box that is dark.
double ink_of(const Word& word, const Raster& page, double pixels_per_point) {
  const auto pixel = [&](double at) { return static_cast<int>(at * pixels_per_point); };
  int dark = 0, all = 0;
  for (int y = pixel(word.y0); y < pixel(word.y1); ++y) {
    for (int x = pixel(word.x0); x < pixel(word.x1); ++x, ++all) dark += *page.at(x, y) < 128;
  }
  return static_cast<double>(dark) / all;
}

TEST_F(PageText, ThereIsInkWhereverThePdfHasAWord) {
  print(kTitle);
  constexpr int kDpi = 300;
  const Raster page = drawn_by_poppler(path("out/print.pdf"), kDpi);
  const std::vector<Word> words = words_of(path("out/print.pdf"));
  EXPECT_GE(words.size(), 9U);
  for (const Word& word : words) {
    if (word.text == "-") continue;
    const double ink = ink_of(word, page, kDpi / 72.0);
    EXPECT_GT(ink, 0.08) << word.text;
    EXPECT_LT(ink, 0.5) << word.text;
  }
}

TEST_F(PageText, TextOfCmykPagesIsOfBlackInkOnly) {
  print(kTitle, {"--colours", "cmyk"});
  const Raster inks = inks_by_mupdf(path("out/print.pdf"), 100);
  int black = 0;
  for (int y = 0; y < inks.height; ++y) {
    for (int x = 0; x < inks.width; ++x) {
      const std::uint8_t* const pixel = inks.at(x, y);
      ASSERT_EQ(pixel[0] + pixel[1] + pixel[2], 0);
      black += pixel[3] > 128;
    }
  }
  EXPECT_GT(black, 500);
  const std::string trace = traced_by_mupdf(path("out/print.pdf"));
  EXPECT_TRUE(std::regex_search(
      trace, std::regex("<fill_text[^>]*colorspace=\"DeviceCMYK\"[^>]*color=\"0 0 0 1\"")))
      << trace.substr(0, 3000);
}

TEST_F(PageText, CharactersThatTheFontLacksAreReplacedAndNamed) {
  const Ended ended = print("Mug 漢字 \U0001F9D9 7");
  EXPECT_NE(ended.err.find("'漢' (U+6F22), '字' (U+5B57), '\U0001F9D9' (U+1F9D9)"),
            std::string::npos)
      << ended.err;
  ASSERT_EQ(warnings().size(), 1U);
  EXPECT_EQ(warnings()[0]["code"], "TEXT_GLYPH_MISSING");
  EXPECT_NE(warnings()[0]["message"].get<std::string>().find("(U+1F9D9)"), std::string::npos);
  EXPECT_NE(text_of("out/print.pdf").find("Mug \uFFFD\uFFFD \uFFFD 7"), std::string::npos);
  const Raster page = drawn_by_poppler(path("out/print.pdf"), 300);
  int replaced = 0;
  for (const Word& word : words_of(path("out/print.pdf"))) {
    if (word.text.find("\uFFFD") == std::string::npos) continue;
    ++replaced;
    EXPECT_GT(ink_of(word, page, 300 / 72.0), 0.15) << word.text;
  }
  EXPECT_EQ(replaced, 2);
}

TEST_F(PageText, CharactersThatShareAGlyphAreToldApart) {
  // No-break spaces, the ohm sign and omega, the micro sign and mu.
  print("10\u00A0k\u2126 \u03A9 5\u00A0\u00B5m \u03BCm");
  const std::string text = text_of("out/print.pdf");
  for (const char* each : {"\u2126", "\u03A9", "\u00B5m", "\u03BCm"}) {
    EXPECT_NE(text.find(each), std::string::npos) << each << " in " << text;
  }
}

TEST_F(PageText, MalformedTextIsReplacedAndWarnedOf) {
  for (const std::string bad : {"Mug \xFF\xFE 7", "Mug \xE6\xBC", "Mug\n\r\t7", "\xED\xA0\x80",
                                "Mug \xF0\x9F\xA6\x8A\x8A"}) {
    print(bad);
    ASSERT_EQ(warnings().size(), 1U);
    EXPECT_EQ(warnings()[0]["code"], "TEXT_GLYPH_MISSING");
    EXPECT_NE(text_of("out/print.pdf").find("\uFFFD"), std::string::npos);
  }
}

TEST_F(PageText, LongTitlesEndInAnEllipsisWithinTheMargin) {
  std::string title = "Mug 7";
  for (int i = 0; i < 100; ++i) title += " ÄÖÜ gjpqy";
  const Ended ended = print(title, {"--printer-margin-mm", "6", "--date", "2025-03-14"});
  EXPECT_NE(ended.err.find("ends in an ellipsis"), std::string::npos) << ended.err;
  const std::string text = text_of("out/print.pdf");
  EXPECT_NE(text.find("Mug 7 ÄÖÜ gjpqy"), std::string::npos) << text;
  EXPECT_NE(text.find("…"), std::string::npos) << text;
  EXPECT_NE(text.find("2025-03-14"), std::string::npos) << text;
  const Raster page = drawn_by_poppler(path("out/print.pdf"), 254);  // ten pixels per millimetre
  for (int y = 0; y < page.height; ++y) {
    for (int x = 0; x < page.width; ++x) {
      const bool is_margin = std::min({x, y, page.width - 1 - x, page.height - 1 - y}) < 59;
      if (!is_margin) continue;
      ASSERT_EQ(*page.at(x, y), 255) << x << " " << y;
    }
  }
}

TEST_F(PageText, ALongTitleOfATemplateLeavesTheOtherLinesAlone) {
  const Ended placed = testing::run({testing::program_path("hydroprint-worker"), "template",
                                     "--mesh", path("pyramid.obj"), "--job-name",
                                     std::string(2000, 'W'), "--out", path("placed")});
  ASSERT_EQ(placed.status, 0) << placed.err;
  EXPECT_NE(placed.err.find("ends in an ellipsis"), std::string::npos) << placed.err;
  const std::string text = text_of("placed/placement.pdf");
  EXPECT_NE(text.find("WWW…"), std::string::npos) << text;
  EXPECT_NE(text.find("placement, seen from above"), std::string::npos) << text;
}

}  // namespace
}  // namespace hydroprint::print
