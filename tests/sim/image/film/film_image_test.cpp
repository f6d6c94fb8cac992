#include "sim/image/film/film_image.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <numeric>

#include "sim/image/io/colour.h"
#include "tests/sim/image/scenes.h"

namespace hydroprint::image {
namespace {

using namespace testing;

Paint paint_of(const mesh::Model& model, const RgbImage& texture) {
  const TemporaryFolder folder;
  EXPECT_TRUE(write_png(folder / "texture.png", texture, 72));
  auto paint = load_paint(model, folder / "texture.png", {});
  EXPECT_TRUE(paint) << (paint ? "" : paint.error().message);
  return std::move(*paint);
}

RgbImage image_of(const mesh::Model& model, const Paint& paint, const film::Outline& outline,
                  double dpi, int threads = 1) {
  const mesh::Surface surface = surface_of(model);
  Context context;
  context.threads = threads;
  auto image = film_image(surface, identity_tiles(surface), paint, outline, dpi, context);
  EXPECT_TRUE(image) << (image ? "" : image.error().message);
  return std::move(*image);
}

bool is(const RgbImage& image, int x, int y, std::array<int, 3> colour) {
  const std::uint8_t* p = image.at(x, y);
  return p[0] == colour[0] && p[1] == colour[1] && p[2] == colour[2];
}

TEST(FilmImage, SizesMatchTheContract) {
  const FilmGrid a4 = film_grid(rectangle(210, 297), 25.4 / 600);
  EXPECT_EQ(a4.columns, 4961);
  EXPECT_EQ(a4.rows, 7016);
  const FilmGrid a4_300 = film_grid(rectangle(210, 297), 25.4 / 300);
  EXPECT_EQ(a4_300.columns, 2480);
  EXPECT_EQ(a4_300.rows, 3508);
  // The image is centred on the film, although the film is not a multiple of the pitch.
  EXPECT_NEAR(a4.cell({0, 0}).x(), 4961 / 2.0, 1e-9);
  EXPECT_NEAR(a4.cell({0, 0}).y(), 7016 / 2.0, 1e-9);
}

TEST(FilmImage, AnInchAt100DpiIsExactly100Pixels) {
  // The plate's lower left corner is the middle of a film of 101.6 x 76.2 mm: 400 x 300 pixels.
  const mesh::Model model = plate(0, 0, 25.4, 25.4);
  const Paint paint = paint_of(model, make_image(4, 4, [](int, int) { return kRed; }));
  const RgbImage image = image_of(model, paint, rectangle(101.6, 76.2), 100);
  ASSERT_EQ(image.width, 400);
  ASSERT_EQ(image.height, 300);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const bool inside = x >= 200 && x < 300 && y >= 50 && y < 150;
      ASSERT_TRUE(is(image, x, y, inside ? kRed : kWhite)) << x << ", " << y;
    }
  }
}

TEST(FilmImage, IsSeenFromAboveWithXToTheRightAndYUp) {
  // The texture's corners: red upper left, green upper right, blue lower left, grey lower right.
  const mesh::Model model = plate(-25.4, -25.4, 25.4, 25.4);
  const Paint paint = paint_of(model, make_image(2, 2, [](int x, int y) {
                                 if (y == 0) return x == 0 ? kRed : kGreen;
                                 return x == 0 ? kBlue : kGrey;
                               }));
  const RgbImage image = image_of(model, paint, rectangle(50.8, 50.8), 50);
  EXPECT_TRUE(is(image, 5, 5, kRed));
  EXPECT_TRUE(is(image, 94, 5, kGreen));
  EXPECT_TRUE(is(image, 5, 94, kBlue));
  EXPECT_TRUE(is(image, 94, 94, kGrey));
}

TEST(FilmImage, AnIdentityMapReproducesTheTexture) {
  // One texel per pixel, so every pixel must have the colour of its texel.
  const auto pattern = [](int x, int y) {
    return std::array<int, 3>{(x * 37 + y * 11) % 256, (x * 5 + y * 91) % 256, (x ^ y) % 256};
  };
  const RgbImage texture = make_image(100, 60, pattern);
  const mesh::Model model = plate(-25.4, -15.24, 25.4, 15.24, 7, 5);
  const RgbImage image = image_of(model, paint_of(model, texture), rectangle(50.8, 30.48), 50);
  ASSERT_EQ(image.width, 100);
  ASSERT_EQ(image.height, 60);
  int worst = 0;
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    worst = std::max(worst, std::abs(int{image.rgb[i]} - int{texture.rgb[i]}));
  }
  // UVs are floats, so a neighbouring texel may contribute 1e-5, which may change the rounding
  // by 1.
  EXPECT_LE(worst, 1);
}

TEST(FilmImage, HalfCoveredPixelsAreBlendedWithWhiteInLinearLight) {
  // The left edge runs through the middle of column 10 of a 20 pixel wide image.
  const double pixel = 25.4 / 100;
  const mesh::Model model = plate(0.5 * pixel, -1, 100, 1);
  const Paint paint = paint_of(model, make_image(2, 2, [](int, int) {
                                 return std::array<int, 3>{0, 0, 0};
                               }));
  const RgbImage image = image_of(model, paint, rectangle(20 * pixel, 4 * pixel), 100);
  EXPECT_TRUE(is(image, 9, 2, kWhite));
  EXPECT_EQ(image.at(10, 2)[0], srgb8_from_linear(0.5F));
  EXPECT_EQ(image.at(11, 2)[0], 0);
}

TEST(FilmImage, AMinifiedCheckerboardIsMidGreyInLinearLight) {
  const RgbImage board = make_image(1024, 1024, [](int x, int y) {
    return (x + y) % 2 == 0 ? kWhite : std::array<int, 3>{0, 0, 0};
  });
  const mesh::Model model = plate(-25.4, -25.4, 25.4, 25.4, 3, 3);
  const RgbImage image = image_of(model, paint_of(model, board), rectangle(50.8, 50.8), 50);
  const int grey = srgb8_from_linear(0.5F);
  for (const std::uint8_t value : image.rgb) ASSERT_NEAR(value, grey, 1);
}

TEST(FilmImage, MinificationAlongOneAxisKeepsTheOtherSharp) {
  // Vertical stripes 8 texels wide. The map shrinks only v, 32 to 1.
  const RgbImage stripes = make_image(256, 2048, [](int x, int y) {
    if (x / 8 % 2 == 1) return std::array<int, 3>{0, 0, 0};
    return y % 2 == 0 ? kWhite : kRed;
  });
  const mesh::Model model = plate(-25.4, -6.35, 25.4, 6.35);
  const RgbImage image = image_of(model, paint_of(model, stripes), rectangle(50.8, 12.7), 128);
  ASSERT_EQ(image.width, 256);
  ASSERT_EQ(image.height, 64);
  for (int y = 8; y < 56; ++y) {
    EXPECT_LT(image.at(12, y)[0], 40) << "middle of a dark stripe";
    EXPECT_GT(image.at(4, y)[0], 240) << "middle of a light stripe";
    EXPECT_NEAR(image.at(4, y)[1], srgb8_from_linear(0.5F), 12);
  }
}

TEST(FilmImage, FilmThatHasLandedStays) {
  mesh::Model model = plate(-10, -10, 10, 10);
  const mesh::Model other = plate(-10, -10, 10, 10);
  for (const auto& t : other.triangles) model.triangles.push_back(t.array() + 4);
  for (const auto& v : other.vertices) model.vertices.push_back(v);
  model.corner_uvs.clear();
  model.vertex_colours = std::vector<Eigen::Vector3f>(8, {1, 0, 0});
  for (int i = 4; i < 8; ++i) model.vertex_colours[i] = {0, 0, 1};
  const mesh::Surface surface = surface_of(model);
  const auto paint = load_paint(model, {}, {});
  ASSERT_TRUE(paint);
  auto tiles = identity_tiles(surface);
  for (const bool blue_first : {false, true}) {
    for (auto& tile : tiles) {
      const bool is_blue = tile.triangle >= 2;
      tile.contact_time_s.fill(is_blue == blue_first ? 3.0F : 4.0F);
    }
    const auto image = film_image(surface, tiles, *paint, rectangle(20, 20), 50, {});
    ASSERT_TRUE(image);
    EXPECT_TRUE(is(*image, 20, 20, blue_first ? kBlue : kRed));
  }
}

TEST(FilmImage, IsBitIdenticalForAnyNumberOfThreads) {
  const RgbImage texture = make_image(300, 200, [](int x, int y) {
    return std::array<int, 3>{x * 7 % 256, y * 13 % 256, (x * y) % 256};
  });
  const mesh::Model model = plate(-40, -30, 45, 35, 23, 17);
  const Paint paint = paint_of(model, texture);
  const RgbImage one = image_of(model, paint, rectangle(100, 100), 200, 1);
  for (const int threads : {2, 5}) {
    EXPECT_EQ(one.rgb, image_of(model, paint, rectangle(100, 100), 200, threads).rgb);
  }
}

TEST(FilmImage, IsWhiteWhenTheModelHasNoColour) {
  mesh::Model model = plate(-10, -10, 10, 10);
  model.corner_uvs.clear();
  const auto paint = load_paint(model, {}, {});
  ASSERT_TRUE(paint);
  EXPECT_FALSE(paint->has_colour());
  const RgbImage image = image_of(model, *paint, rectangle(20, 20), 100);
  EXPECT_EQ(std::accumulate(image.rgb.begin(), image.rgb.end(), 0L),
            255L * static_cast<long>(image.rgb.size()));
}

TEST(FilmImage, BrokenTilesAreLeftOut) {
  const mesh::Model model = plate(-10, -10, 10, 10);
  const mesh::Surface surface = surface_of(model);
  const Paint paint = paint_of(model, make_image(2, 2, [](int, int) { return kRed; }));
  auto tiles = identity_tiles(surface);
  tiles[0].film_mm[1].x() = std::nan("");
  tiles[1].film_mm[1] = {1e200, -1e200};
  const auto image = film_image(surface, tiles, paint, rectangle(20, 20), 100, {});
  ASSERT_TRUE(image);
  EXPECT_TRUE(is(*image, 30, 30, kWhite));
}

TEST(FilmImage, RefusesResolutionsAndSizesOutOfRange) {
  const mesh::Model model = plate(-10, -10, 10, 10);
  const mesh::Surface surface = surface_of(model);
  const Paint paint = paint_of(model, make_image(2, 2, [](int, int) { return kRed; }));
  for (const double dpi : {19.9, 2401.0, std::nan(""), -300.0}) {
    const auto image =
        film_image(surface, identity_tiles(surface), paint, rectangle(20, 20), dpi, {});
    ASSERT_FALSE(image);
    EXPECT_EQ(image.error().code, Code::kOutOfRange);
  }
  const auto huge =
      film_image(surface, identity_tiles(surface), paint, rectangle(1000, 1000), 1200, {});
  ASSERT_FALSE(huge);
  EXPECT_EQ(huge.error().code, Code::kOutOfRange);
}

TEST(FilmImage, StopsWhenCancelled) {
  const mesh::Model model = plate(-10, -10, 10, 10);
  const mesh::Surface surface = surface_of(model);
  const Paint paint = paint_of(model, make_image(2, 2, [](int, int) { return kRed; }));
  Context context;
  context.cancelled = [] { return true; };
  const auto image =
      film_image(surface, identity_tiles(surface), paint, rectangle(20, 20), 100, context);
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().code, Code::kCancelled);
}

TEST(WritePng, KeepsPixelsAndResolution) {
  const TemporaryFolder folder;
  const RgbImage image = make_image(31, 17, [](int x, int y) {
    return std::array<int, 3>{x * 8, y * 15, 255 - x};
  });
  ASSERT_TRUE(write_png(folder / "film.png", image, 600));
  const auto input = OIIO::ImageInput::open((folder / "film.png").string());
  ASSERT_TRUE(input);
  const OIIO::ImageSpec& spec = input->spec();
  EXPECT_EQ(spec.width, 31);
  EXPECT_EQ(spec.height, 17);
  EXPECT_EQ(spec.nchannels, 3);
  EXPECT_EQ(spec.get_string_attribute("ResolutionUnit").substr(0, 2), "in");
  EXPECT_NEAR(spec.get_float_attribute("XResolution"), 600, 0.05);
  EXPECT_NEAR(spec.get_float_attribute("YResolution"), 600, 0.05);
  std::vector<std::uint8_t> pixels(image.rgb.size());
  ASSERT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, pixels.data()));
  EXPECT_EQ(pixels, image.rgb);
}

TEST(WritePng, AFileBeyondTheLimitIsReportedAndLeavesNothingBehind) {
  // Random pixels do not compress.
  const TemporaryFolder folder;
  unsigned state = 1;
  const RgbImage image = make_image(100, 100, [&](int, int) {
    state = state * 1664525 + 1013904223;
    return std::array<int, 3>{static_cast<int>(state >> 24), static_cast<int>(state >> 16 & 255),
                              static_cast<int>(state >> 8 & 255)};
  });
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit limited = before;
  limited.rlim_cur = 4096;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limited), 0);
  const Status status = write_png(folder / "film.png", image, 300);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, Code::kResourceExhausted);
  EXPECT_EQ(status.error().reason, ErrorReason::OUTPUT_LIMIT);
  EXPECT_TRUE(std::filesystem::is_empty(folder / ""));
}

TEST(WritePng, LeavesNothingBehindIfItCannotWrite) {
  const TemporaryFolder folder;
  const RgbImage image = make_image(4, 4, [](int, int) { return kRed; });
  const Status missing = write_png(folder / "nowhere/film.png", image, 300);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Code::kNotFound);
  std::filesystem::create_directory(folder / "film.png");
  ASSERT_FALSE(write_png(folder / "film.png", image, 300));
  int entries = 0;
  for ([[maybe_unused]] const auto& e : std::filesystem::directory_iterator(folder / "")) ++entries;
  EXPECT_EQ(entries, 1);
}

}  // namespace
}  // namespace hydroprint::image
