// The mask of a film, and film seen through it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/image/film/film_image.h"
#include "tests/sim/image/scenes.h"

namespace hydroprint::image {
namespace {

using namespace testing;

/// A weight that rises with x from 0 at -10 mm to 1 at 10 mm, and stays 1 beyond.
Weight ramp_on(const mesh::Surface& surface) {
  return [&surface](int triangle, const Eigen::Vector3d& at) {
    const Eigen::Vector3i& t = surface.triangles[static_cast<std::size_t>(triangle)];
    double x_mm = 0;
    for (int i = 0; i < 3; ++i) x_mm += at[i] * surface.points[static_cast<std::size_t>(t[i])].x();
    return static_cast<float>(std::min(1.0, (x_mm + 10) / 20));
  };
}

RgbImage mask_of(const mesh::Surface& surface, const std::vector<flow::MappedTriangle>& tiles,
                 const film::Outline& outline, int threads = 1) {
  Context context;
  context.threads = threads;
  auto mask = film_mask(tiles, ramp_on(surface), outline, 254, context);
  EXPECT_TRUE(mask) << (mask ? "" : mask.error().message);
  return std::move(*mask);
}

TEST(FilmMask, ShowsTheWeightAtThePixelsAndNothingBeyondTheFilm) {
  const mesh::Surface surface = surface_of(plate(-10, -5, 10, 5, 7, 3));
  const RgbImage mask = mask_of(surface, identity_tiles(surface), rectangle(30, 20));
  ASSERT_EQ(mask.width, 300);
  ASSERT_EQ(mask.height, 200);
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      const double x_mm = (x + 0.5) / 10 - 15, y_mm = 10 - (y + 0.5) / 10;
      const bool lands = std::abs(x_mm) < 10 && std::abs(y_mm) < 5;
      const double expected = lands ? 255 * (x_mm + 10) / 20 : 0;
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(mask.at(x, y)[c], expected, 1) << x << ", " << y;
    }
  }
}

TEST(FilmMask, PixelOnTheEdgeOfTheFilmHasTheWeightOfThePartThatLands) {
  // The film's image ends in the middle of a column of pixels, where its weight is 1.
  const mesh::Surface surface = surface_of(plate(-10, -5, 10.05, 5));
  const RgbImage mask = mask_of(surface, identity_tiles(surface), rectangle(30, 20));
  EXPECT_GE(mask.at(250, 100)[0], 254);
  EXPECT_EQ(mask.at(251, 100)[0], 0);
}

TEST(FilmMask, FilmThatLandsFirstDecides) {
  const mesh::Surface surface = surface_of(plate(-10, -5, 10, 5));
  auto tiles = identity_tiles(surface);
  auto later =
      tiles_of(surface, [](const Eigen::Vector3d& p) { return Eigen::Vector2d(-p.x(), -p.y()); });
  for (auto& tile : later) {
    tile.contact_time_s.fill(2);
    tiles.push_back(tile);
  }
  const RgbImage mask = mask_of(surface, tiles, rectangle(30, 20));
  EXPECT_NEAR(mask.at(60, 100)[0], 255 * (-8.95 + 10) / 20, 1);
}

TEST(FilmMask, IsBitIdenticalForAnyNumberOfThreads) {
  const mesh::Surface surface = surface_of(plate(-40, -30, 45, 35, 23, 17));
  const auto one = mask_of(surface, identity_tiles(surface), rectangle(100, 100), 1);
  EXPECT_EQ(one.rgb, mask_of(surface, identity_tiles(surface), rectangle(100, 100), 4).rgb);
}

TEST(FilmMask, FilmSeenThroughItFadesToWhiteInCodedColours) {
  const RgbImage image = make_image(3, 1, [](int, int) { return std::array<int, 3>{255, 100, 0}; });
  const RgbImage mask = make_image(3, 1, [](int x, int) {
    return std::array<int, 3>{127 * x + x / 2, 127 * x + x / 2, 127 * x + x / 2};
  });
  const RgbImage film = seen_through(mask, image);
  const auto pixel = [&](int x) {
    return std::array<int, 3>{film.at(x, 0)[0], film.at(x, 0)[1], film.at(x, 0)[2]};
  };
  EXPECT_EQ(pixel(0), kWhite);
  EXPECT_EQ(pixel(1), (std::array<int, 3>{255, 178, 128}));  // w = 127/255
  EXPECT_EQ(pixel(2), (std::array<int, 3>{255, 100, 0}));
}

TEST(FilmMask, TwoFilmsWhoseWeightsSumToOneAddUpToThePicture) {
  const RgbImage image = make_image(256, 1, [](int x, int) {
    return std::array<int, 3>{x, 77, 3};
  });
  const auto grey = [](int level) {
    return [level](int x, int) {
      const int weight = (x + level) % 256;
      const int value = level == 0 ? weight : 255 - x % 256;
      return std::array<int, 3>{value, value, value};
    };
  };
  const RgbImage first = seen_through(make_image(256, 1, grey(0)), image);
  const RgbImage second = seen_through(make_image(256, 1, grey(1)), image);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    const int ink = (255 - first.rgb[i]) + (255 - second.rgb[i]);
    EXPECT_NEAR(ink, 255 - image.rgb[i], 1);
  }
}

}  // namespace
}  // namespace hydroprint::image
