// The verb print-image. Other programs read its files, and the tests measure the results.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <thread>

#include "sim/image/io/image_file.h"
#include "sim/image/io/printer_image.h"
#include "tests/sim/print/raster_files.h"
#include "tests/support/paths.h"
#include "tests/support/process.h"

namespace hydroprint::print {
namespace {

using testing::Ended;
using Arguments = std::vector<std::string>;

image::RgbImage blank(int width, int height) {
  return {width, height,
          std::vector<std::uint8_t>(3U * static_cast<unsigned>(width * height), 255)};
}

void fill(image::RgbImage& image, int x0, int y0, int x1, int y1, const image::Rgb8& colour) {
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) std::copy(colour.begin(), colour.end(), image.at(x, y));
  }
}

/// An image like a photograph: smooth, with noise.
image::RgbImage scenery(int width, int height) {
  std::mt19937 random(5);
  image::RgbImage out = blank(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      out.at(x, y)[0] = static_cast<std::uint8_t>(200 * x / width + random() % 16);
      out.at(x, y)[1] = static_cast<std::uint8_t>(200 * y / height + random() % 16);
      out.at(x, y)[2] = static_cast<std::uint8_t>(random() % 200);
    }
  }
  return out;
}

class PrintImage : public ::testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return folder.path() / name; }
  void film(const image::RgbImage& image) const {
    ASSERT_TRUE(image::write_png(path("film.png"), image, 300));
  }
  [[nodiscard]] Arguments command(const Arguments& more, const std::string& out = "out") const {
    Arguments all = {testing::program_path("hydroprint-worker"),
                     "print-image",
                     "--film-image",
                     path("film.png"),
                     "--out",
                     path(out)};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  nlohmann::json print(const Arguments& more, const std::string& out = "out") const {
    const Ended ended = testing::run(command(more, out));
    EXPECT_EQ(ended.status, 0) << ended.err;
    return nlohmann::json::parse(bytes_of(path(out) + "/report.json"));
  }

  testing::TemporaryFolder folder;
};

/// Middles of the dark lines in a row or column of grey values, in pixels.
std::vector<double> lines_in(const std::vector<int>& grey) {
  std::vector<double> out;
  double weight = 0, sum = 0;
  for (std::size_t i = 0; i < grey.size(); ++i) {
    const double dark = 255 - grey[i];
    if (dark < 3) {
      if (weight > 100) out.push_back(sum / weight);
      weight = sum = 0;
      continue;
    }
    weight += dark;
    sum += dark * (static_cast<double>(i) + 0.5);
  }
  if (weight > 100) out.push_back(sum / weight);
  return out;
}

TEST_F(PrintImage, ThePdfsScaleIsExactOverTheWholeFilm) {
  // A4 at 150 dpi; lines of one pixel, 280 mm apart along the page and 180 mm across it.
  image::RgbImage image = blank(1240, 1754);
  const int y0 = 50, y1 = 50 + 1654, x0 = 80, x1 = 80 + 1063;
  for (const int y : {y0, y1}) fill(image, 0, y, 1240, y + 1, {0, 0, 0});
  for (const int x : {x0, x1}) fill(image, x, 0, x + 1, 1754, {0, 0, 0});
  film(image);
  print({"--formats", "pdf"});
  const Ended info = testing::run({"/usr/bin/pdfinfo", path("out/print.pdf")});
  EXPECT_NE(info.out.find("595.276 x 841.89 pts (A4)"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("Pages:           1"), std::string::npos) << info.out;
  EXPECT_EQ(info.out.find("Date"), std::string::npos) << info.out;

  constexpr int kDpi = 600;
  constexpr double kMmPerPixel = 25.4 / kDpi, kPitch_mm = 25.4 / 150;
  const Raster page = drawn_by_poppler(path("out/print.pdf"), kDpi);
  std::vector<int> column, row;
  for (int y = 0; y < page.height; ++y) column.push_back(*page.at(page.width / 2, y));
  for (int x = 0; x < page.width; ++x) row.push_back(*page.at(x, page.height / 2));
  const auto across = lines_in(row), along = lines_in(column);
  ASSERT_EQ(along.size(), 2U);
  ASSERT_EQ(across.size(), 2U);
  // The tolerance is needed because poppler aligns images to whole pixels.
  EXPECT_NEAR((along[1] - along[0]) * kMmPerPixel, (y1 - y0) * kPitch_mm, 0.05);
  EXPECT_NEAR((across[1] - across[0]) * kMmPerPixel, (x1 - x0) * kPitch_mm, 0.05);
  // The film's middle must be at the paper's middle.
  EXPECT_NEAR(along[0] * kMmPerPixel, 148.5 + (y0 + 0.5 - 877) * kPitch_mm, 0.05);
  EXPECT_NEAR(across[0] * kMmPerPixel, 105 + (x0 + 0.5 - 620) * kPitch_mm, 0.05);
}

TEST_F(PrintImage, ImageAndRulerSizesAreExactToTheMicrometre) {
  film(scenery(787, 787));  // 200 mm at 100 dpi
  print({"--film", "200x200", "--paper", "A3", "--formats", "pdf"});
  const std::string trace = traced_by_mupdf(path("out/print.pdf"));
  std::smatch match;
  const std::regex placed("fill_image[^>]*transform=\"([^ ]+) 0 0 ([^ ]+) ");
  ASSERT_TRUE(std::regex_search(trace, match, placed)) << trace.substr(0, 2000);
  EXPECT_NEAR(std::abs(std::stod(match[1])) * 25.4 / 72, 787 * 0.254, 1e-3);
  EXPECT_NEAR(std::abs(std::stod(match[2])) * 25.4 / 72, 787 * 0.254, 1e-3);
  // Lines with two points. The longest of them belong to the rulers.
  const std::regex line(
      "<moveto x=\"([^\"]+)\" y=\"([^\"]+)\"/>\\s*<lineto x=\"([^\"]+)\" y=\"([^\"]+)\"/>\\s*</");
  int rulers = 0;
  for (std::sregex_iterator at(trace.begin(), trace.end(), line), end; at != end; ++at) {
    const double x = std::stod((*at)[3]) - std::stod((*at)[1]);
    const double y = std::stod((*at)[4]) - std::stod((*at)[2]);
    const double length_mm = std::hypot(x, y) * 25.4 / 72;
    rulers += std::abs(length_mm - 200) < 1e-3 ? 1 : 0;
    EXPECT_LT(length_mm, 200 + 1e-3);
  }
  EXPECT_EQ(rulers, 2);
}

TEST_F(PrintImage, PngAndTiffHoldTheFilmImageUnchangedWithItsResolution) {
  const image::RgbImage image = scenery(1181, 945);
  film(image);
  print({"--film", "100x80", "--formats", "png,tiff"});
  for (const std::string name : {"out/print.png", "out/print.tif"}) {
    const auto read = image::read_image(path(name), {});
    ASSERT_TRUE(read) << name;
    ASSERT_EQ(read->image.width, image.width);
    std::vector<std::uint8_t> row(3U * 1181);
    for (int y = 0; y < image.height; ++y) {
      image::srgb8_row(read->image, y, row.data());
      ASSERT_TRUE(std::equal(row.begin(), row.end(), image.at(0, y))) << name;
    }
  }
  const PngResolution png = png_resolution(path("out/print.png"));
  EXPECT_EQ(png.per_metre_x, 11811U);  // 300 dpi
  EXPECT_EQ(png.per_metre_y, 11811U);
  auto tiff = tiff_tags(path("out/print.tif"));
  EXPECT_EQ(tiff[282], 300);
  EXPECT_EQ(tiff[283], 300);
  EXPECT_EQ(tiff[296], 2);  // inches
  EXPECT_EQ(tiff[277], 3);
  EXPECT_EQ(tiff[262], 2);  // RGB
}

TEST_F(PrintImage, CmykIsUnchangedInPdfAndTiffAndRespectsTheInkLimit) {
  image::RgbImage image = blank(400, 300);
  fill(image, 0, 0, 100, 300, {0, 0, 0});
  fill(image, 100, 0, 200, 300, {255, 0, 0});
  fill(image, 200, 0, 300, 300, {60, 90, 30});
  film(image);
  const Arguments small = {"--film", "101.6x76.2", "--paper", "101.6x76.2", "--colours", "cmyk"};
  Arguments limited = small;
  limited.insert(limited.end(), {"--ink-limit", "1.2"});
  const std::array<int, 4> black = {0, 0, 0, 255}, white = {0, 0, 0, 0};
  // The colour (60, 90, 30) has K = 165, and C, M, Y = 1/3, 0, 2/3 of 255.
  for (const auto& [flags, red, green] :
       {std::tuple{small, std::array<int, 4>{0, 255, 255, 0}, std::array<int, 4>{85, 0, 170, 165}},
        std::tuple{limited, std::array<int, 4>{0, 153, 153, 0},
                   std::array<int, 4>{47, 0, 94, 165}}}) {
    const auto report = print(flags);
    EXPECT_EQ(report["colours"], "COLOURS_CMYK");
    EXPECT_NEAR(report["most_ink"], (flags == small ? 510 : 306) / 255.0, 1e-9);
    for (const std::string name : {"out/print.pdf", "out/print.tif"}) {
      const Raster inks = inks_by_mupdf(path(name), 100);
      ASSERT_EQ(inks.channels, 4) << name;
      ASSERT_EQ(inks.width, 400);
      const std::array<std::array<int, 4>, 4> expected = {black, red, green, white};
      for (std::size_t i = 0; i < 4; ++i) {
        const std::uint8_t* got = inks.at(static_cast<int>(50 + 100 * i), 150);
        for (std::size_t c = 0; c < 4; ++c) EXPECT_EQ(got[c], expected[i][c]) << name << " " << i;
      }
    }
  }
  auto tiff = tiff_tags(path("out/print.tif"));
  EXPECT_EQ(tiff[262], 5);  // separated (CMYK)
  EXPECT_EQ(tiff[277], 4);
}

TEST_F(PrintImage, TilesJoinToTheOriginalImage) {
  const image::RgbImage image = scenery(1181, 827);  // 300 x 210 mm at 100 dpi
  film(image);
  const auto report = print(
      {"--film", "300x210", "--paper", "150x120", "--overlap-mm", "8", "--formats", "pdf,png"});
  image::RgbImage joined = blank(1181, 827);
  std::vector<int> times(1181 * 827);
  int number = 0;
  for (const auto& sheet : report["sheets"]) {
    const auto part = image::read_image(path("out/print-" + std::to_string(++number) + ".png"), {});
    ASSERT_TRUE(part);
    const int x0 = sheet["window_px"][0], y0 = sheet["window_px"][1];
    ASSERT_EQ(part->image.width, static_cast<int>(sheet["window_px"][2]) - x0);
    std::vector<std::uint8_t> row(3 * static_cast<std::size_t>(part->image.width));
    for (int y = 0; y < part->image.height; ++y) {
      image::srgb8_row(part->image, y, row.data());
      for (int x = 0; x < part->image.width; ++x) {
        const std::size_t place = static_cast<std::size_t>(y0 + y) * 1181 + x0 + x;
        if (times[place]++ > 0) {
          ASSERT_TRUE(std::equal(&row[3U * x], &row[3U * x] + 3, joined.at(x0 + x, y0 + y)));
        }
        std::copy(&row[3U * x], &row[3U * x] + 3, joined.at(x0 + x, y0 + y));
      }
    }
  }
  EXPECT_EQ(joined.rgb, image.rgb);
  EXPECT_GT(number, 3);
  const Ended info = testing::run({"/usr/bin/pdfinfo", path("out/print.pdf")});
  EXPECT_NE(info.out.find("Pages:           " + std::to_string(number) + "\n"), std::string::npos)
      << info.out;
}

TEST_F(PrintImage, AReprintIsByteIdentical) {
  film(scenery(620, 877));
  const Arguments flags = {"--film",    "105x148.5",    "--paper",    "A4",
                           "--formats", "pdf,png,tiff", "--job-name", "mug 3",
                           "--date",    "2025-03-14",   "--mirror"};
  Arguments one = flags, two = flags;
  one.insert(one.end(), {"--threads", "1"});
  two.insert(two.end(), {"--threads", "3"});
  print(one, "one");
  // Waits, so that files that contain the time of writing would differ.
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  print(two, "two");
  for (const std::string name : {"/print.pdf", "/print.png", "/print.tif"}) {
    EXPECT_TRUE(bytes_of(path("one") + name) == bytes_of(path("two") + name)) << name;
  }
}

TEST_F(PrintImage, MirroringSwapsLeftAndRight) {
  image::RgbImage image = blank(118, 118);
  fill(image, 0, 0, 10, 118, {10, 20, 30});
  film(image);
  print({"--film", "30x30", "--formats", "png", "--mirror"});
  const auto read = image::read_image(path("out/print.png"), {});
  ASSERT_TRUE(read);
  std::vector<std::uint8_t> row(3U * 118);
  image::srgb8_row(read->image, 60, row.data());
  EXPECT_EQ(row[0], 255);
  EXPECT_EQ(row[3 * 107 + 1], 255);
  EXPECT_EQ(row[3 * 108 + 1], 20);
}

TEST_F(PrintImage, AnImageInThePrintersMarginIsCutOffWithAWarning) {
  image::RgbImage image = blank(827, 1169);  // A4 at 100 dpi
  fill(image, 400, 500, 500, 600, {0, 0, 255});
  film(image);
  // The only warning is about marks.
  EXPECT_EQ(print({"--printer-margin-mm", "5"})["run"]["warnings"].size(), 1U);
  fill(image, 0, 500, 400, 600, {0, 0, 255});
  film(image);
  const auto report = print({"--printer-margin-mm", "5", "--formats", "png"});
  const auto& warnings = report["run"]["warnings"];
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_EQ(warnings[1]["code"], "IMAGE_IN_PRINTER_MARGIN");
  EXPECT_EQ(warnings[1]["where"]["sheet"], 1);
  // 5 mm of a strip 25.4 mm high, rounded to whole pixels.
  EXPECT_NEAR(report["cut_off_mm2"], 5 * 25.4, 0.254 * 25.4);
  const auto read = image::read_image(path("out/print.png"), {});
  std::vector<std::uint8_t> row(3U * 827);
  image::srgb8_row(read->image, 550, row.data());
  EXPECT_EQ(row[3 * 18], 255);
  EXPECT_EQ(row[3 * 21], 0);
}

TEST_F(PrintImage, AnUncertainPoseIsAWarningBeforeAnythingIsPrinted) {
  film(blank(118, 118));
  folder.write("sure.json", R"({"translation_mm": [0, 0, 0], "error_p95_mm": 0.3})");
  const auto sure = print({"--film", "30x30", "--pose", path("sure.json")});
  folder.write("unsure.json", R"({"translation_mm": [0, 0, 0], "error_p95_mm": 4})");
  const auto unsure = print({"--film", "30x30", "--pose", path("unsure.json")});
  EXPECT_EQ(unsure["run"]["warnings"].size(), sure["run"]["warnings"].size() + 1);
  EXPECT_EQ(unsure["run"]["warnings"][0]["code"], "POSE_UNCERTAIN");
}

TEST_F(PrintImage, FilmOfThePapersSizeIsPrintedWithoutMarksWithAWarning) {
  film(blank(827, 1169));
  const Ended ended = testing::run(command({}));
  EXPECT_EQ(ended.status, 0);
  EXPECT_NE(ended.err.find("so these are left out"), std::string::npos) << ended.err;
  EXPECT_EQ(traced_by_mupdf(path("out/print.pdf")).find("stroke_path"), std::string::npos);
  testing::run(command({"--no-marks"}, "silent"));
  EXPECT_EQ(nlohmann::json::parse(bytes_of(path("silent/report.json")))["run"]["warnings"].size(),
            0U);
}

TEST_F(PrintImage, TheProfileIsEmbedded) {
  film(blank(118, 118));
  const std::string icc = "/usr/share/color/icc/ghostscript/default_cmyk.icc";
  print({"--film", "30x30", "--icc-profile", icc});
  const Ended check = testing::run({"/usr/bin/mutool", "show", path("out/print.pdf"),
                                    "trailer/Root/OutputIntents/1/DestOutputProfile/N"});
  EXPECT_EQ(check.out, "4\n") << check.err;
  EXPECT_EQ(tiff_tags(path("out/print.tif"))[34675],
            static_cast<double>(std::filesystem::file_size(icc)));
}

}  // namespace
}  // namespace hydroprint::print
