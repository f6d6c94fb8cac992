#include "sim/ink/ink_of.h"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <random>

#include "sim/image/io/image_file.h"
#include "sim/ink/separation.h"
#include "tests/sim/ink/films.h"
#include "tests/sim/ink/printers.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::ink {
namespace {

using Eigen::Vector2d;

image::RgbImage picture(int width, int height,
                        const std::function<std::array<int, 3>(int x, int y)>& colour) {
  image::RgbImage out{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (const int code : colour(x, y)) out.rgb.push_back(static_cast<std::uint8_t>(code));
    }
  }
  return out;
}

image::RgbImage noise(int width, int height) {
  std::mt19937 random(23);
  return picture(width, height, [&](int, int) {
    return std::array<int, 3>{static_cast<int>(random() % 256), static_cast<int>(random() % 256),
                              static_cast<int>(random() % 256)};
  });
}

double pixel_mean(const image::RgbImage& picture, const Separation& separation) {
  std::vector<double> t(static_cast<std::size_t>(picture.width) * picture.height);
  separation(picture.rgb.data(), t.size(), t.data());
  double sum = 0;
  for (const double amount : t) sum += amount;
  return sum / static_cast<double>(t.size());
}

std::vector<double> cells(const InkField& field) {
  std::vector<double> out;
  for (int j = 0; j < field.grid().rows; ++j) {
    for (int i = 0; i < field.grid().columns; ++i) {
      out.push_back(field.at(field.grid().centre_mm(i, j)));
    }
  }
  return out;
}

InkField ink(const image::RgbImage& picture, const film::Outline& outline,
             const InkOptions& options = {}, int threads = 2) {
  Context context;
  context.threads = threads;
  auto field = ink_of(picture, outline, options, context);
  EXPECT_TRUE(field) << field.error().message;
  return field ? *field : InkField();
}

TEST(InkOf, PlainColoursArePlainInk) {
  const film::Outline outline = outline_of("60x40");
  const std::vector<std::pair<std::array<int, 3>, double>> colours = {
      {{255, 255, 255}, 0}, {{255, 0, 0}, 2}, {{0, 0, 0}, 1}, {{0, 255, 255}, 1}};
  for (const auto& [colour, t] : colours) {
    const InkField field = ink(picture(37, 91, [&, c = colour](int, int) { return c; }), outline);
    for (const double amount : cells(field)) ASSERT_NEAR(amount, t, 1e-12);
    EXPECT_NEAR(field.total_mm2(), t * 60 * 40, 1e-9);
  }
}

TEST(InkOf, NoInkIsLostOrGainedForAnyImageSize) {
  const film::Outline outline = outline_of("60x40");
  const std::vector<std::pair<int, int>> sizes = {{1, 1},    {3, 2},    {7, 500},
                                                  {130, 80}, {121, 79}, {997, 661}};
  for (const auto& [width, height] : sizes) {
    const image::RgbImage image = noise(width, height);
    const double mean = pixel_mean(image, *make_separation({}));
    for (const double cell_mm : {0.5, 0.77, 7.0, 100.0}) {
      InkOptions options;
      options.cell_mm = cell_mm;
      EXPECT_NEAR(ink(image, outline, options).total_mm2() / 2400, mean, 1e-12)
          << width << " x " << height << ", " << cell_mm << " mm";
    }
  }
}

TEST(InkOf, ImagesOfWholeDotsPerInchKeepTheirPitch) {
  // 10 dpi is 2.54 mm per pixel; 24 x 16 pixels are 60.96 x 40.64 mm, slightly more than the film.
  const image::RgbImage image = picture(24, 16, [](int x, int) {
    return x < 12 ? std::array<int, 3>{255, 0, 0} : std::array<int, 3>{255, 255, 255};
  });
  const InkField more = ink(image, outline_of("60x40"));
  EXPECT_NEAR(more.total_mm2(), 2 * 30 * 40, 1e-9) << "ink beyond the film is cut off";
  // The image is slightly smaller than this film.
  const InkField less = ink(image, outline_of("62x41"));
  EXPECT_NEAR(less.total_mm2(), 2 * 12 * 2.54 * 16 * 2.54, 1e-9);
  EXPECT_NEAR(less.at({-15, 0}), 2, 1e-12);
}

TEST(InkOf, EachPixelsInkIsAtThePixelsPlace) {
  // A picture without symmetry: red top left, black bottom right.
  const film::Outline outline = outline_of("40x20");
  const image::RgbImage image = picture(4, 2, [](int x, int y) {
    if (x == 0 && y == 0) return std::array<int, 3>{255, 0, 0};
    if (x == 3 && y == 1) return std::array<int, 3>{0, 0, 0};
    return std::array<int, 3>{255, 255, 255};
  });
  const InkField field = ink(image, outline);
  EXPECT_NEAR(field.at({-15, 5}), 2, 1e-12);
  EXPECT_NEAR(field.at({15, -5}), 1, 1e-12);
  EXPECT_EQ(field.at({15, 5}), 0);
  EXPECT_EQ(field.at({-15, -5}), 0);
  EXPECT_NEAR(field.mean({-20, 0}, {-10, 0}, {-20, 10}), 2, 0.1)
      << "only cells at the edge may differ";
}

TEST(InkOf, ConvertsPixelsBeforeItAveragesThem) {
  // Black and white dots have a mean of t = 0.5. Grey of the same reflectance (188 of 255) would
  // have t = 0.26.
  const film::Outline outline = outline_of("40x20");
  const image::RgbImage image = picture(1600, 800, [](int x, int y) {
    return (x + y) % 2 ? std::array<int, 3>{0, 0, 0} : std::array<int, 3>{255, 255, 255};
  });
  for (const double amount : cells(ink(image, outline))) ASSERT_NEAR(amount, 0.5, 1e-12);
}

TEST(InkOf, IccProfilesKeepTheInkAndErrorsNameTheProfile) {
  const hydroprint::testing::TemporaryFolder folder;
  InkOptions options;
  options.icc_profile = folder.write("printer.icc", testing::icc_profile({}));
  const image::RgbImage image = noise(640, 411);
  const double mean = pixel_mean(image, *make_separation(options.icc_profile));
  EXPECT_NEAR(ink(image, outline_of("60x40"), options).total_mm2() / 2400, mean, 1e-12);
  const image::RgbImage black = picture(20, 20, [](int, int) { return std::array<int, 3>{}; });
  EXPECT_NEAR(ink(black, outline_of("60x40"), options).at({0, 0}), 3, 1e-3);
  EXPECT_NEAR(ink(black, outline_of("60x40")).at({0, 0}), 1, 1e-12);

  options.icc_profile = folder.path() / "none.icc";
  const auto refused = ink_of(image, outline_of("60x40"), options, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::kNotFound);
  EXPECT_NE(refused.error().message.find("none.icc"), std::string::npos);
}

TEST(InkOf, IsBitIdenticalForAnyNumberOfThreads) {
  const hydroprint::testing::TemporaryFolder folder;
  const image::RgbImage image = noise(1234, 777);
  InkOptions icc;
  icc.icc_profile = folder.write("printer.icc", testing::icc_profile({}));
  for (const InkOptions& options : {InkOptions{}, icc}) {
    const auto one = cells(ink(image, outline_of("A4"), options, 1));
    for (const int threads : {2, 3, 8}) {
      EXPECT_EQ(cells(ink(image, outline_of("A4"), options, threads)), one) << threads;
    }
  }
}

TEST(InkOf, StopsWhenCancelled) {
  Context context;
  context.cancelled = [] { return true; };
  const auto field = ink_of(noise(10, 10), outline_of("A4"), {}, context);
  ASSERT_FALSE(field);
  EXPECT_EQ(field.error().code, Code::kCancelled);
}

TEST(ReadInkImage, FileGivesTheInkOfItsPixels) {
  const hydroprint::testing::TemporaryFolder folder;
  const image::RgbImage image = noise(321, 123);
  const auto path = folder.path() / "ink.png";
  ASSERT_TRUE(image::write_png(path, image, 72));
  const auto field = read_ink_image(path, outline_of("60x40"), {}, {});
  ASSERT_TRUE(field) << field.error().message;
  EXPECT_EQ(cells(*field), cells(ink(image, outline_of("60x40"))));
}

TEST(ReadInkImage, ClearFilmCarriesNoInk) {
  const hydroprint::testing::TemporaryFolder folder;
  const auto path = folder.path() / "clear.png";
  ASSERT_TRUE(image::write_png_rgba(path, 2, 1, {255, 0, 0, 0, 255, 0, 0, 255}));
  const auto field = read_ink_image(path, outline_of("60x40"), {}, {});
  ASSERT_TRUE(field) << field.error().message;
  EXPECT_EQ(field->at({-15, 0}), 0);
  EXPECT_NEAR(field->at({15, 0}), 2, 1e-12);
}

TEST(ReadInkImage, OtherFilesAreRefused) {
  const hydroprint::testing::TemporaryFolder folder;
  const auto missing = read_ink_image(folder.path() / "ink.png", outline_of("A4"), {}, {});
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Code::kNotFound);
  const auto text = read_ink_image(folder.write("ink.png", "no image"), outline_of("A4"), {}, {});
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().code, Code::kInvalidArgument);
  EXPECT_NE(text.error().message.find("ink.png"), std::string::npos);
}

}  // namespace
}  // namespace hydroprint::ink
