#include "sim/image/film/landed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>

#include "sim/image/figures/pictures.h"
#include "sim/image/io/colour.h"
#include "tests/sim/image/scenes.h"

namespace hydroprint::image {
namespace {

using namespace testing;

RgbImage smooth_texture(int width, int height) {
  return make_image(width, height, [&](int x, int y) {
    return std::array<int, 3>{x * 255 / width, y * 255 / height, 128};
  });
}

/// A plate of 60 x 40 mm printed from its texture by the identity map.
struct Printed {
  mesh::Model model = plate(-30, -20, 30, 20, 6, 4);
  mesh::Surface surface = surface_of(model);
  film::Outline outline = rectangle(80, 60);
  std::vector<flow::MappedTriangle> tiles = identity_tiles(surface);
  RgbImage texture = smooth_texture(300, 200);
  RgbImage film;

  Printed() {
    const TemporaryFolder folder;
    EXPECT_TRUE(write_png(folder / "t.png", texture, 72));
    const auto paint = load_paint(model, folder / "t.png", {});
    EXPECT_TRUE(paint);
    auto image = film_image(surface, tiles, *paint, outline, 127, {});
    EXPECT_TRUE(image);
    film = std::move(*image);
  }
};

TEST(Landed, ColoursPerPointMatchTheTexture) {
  const Printed printed;
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder / "film.png", printed.film, 127));
  const auto film = FilmTexture::read(folder / "film.png", printed.outline, {});
  ASSERT_TRUE(film) << film.error().message;
  flow::SurfaceMap map;
  for (const auto& p : printed.surface.points) map.film_mm.emplace_back(p.head<2>());
  map.film_mm[17] = {std::nan(""), 0};
  const auto colours = landed_colours(map, *film);
  ASSERT_EQ(colours.size(), printed.surface.points.size());
  for (std::size_t i = 0; i < colours.size(); ++i) {
    if (i == 17) {
      EXPECT_TRUE(std::isnan(colours[i].x()));
      continue;
    }
    const Eigen::Vector2d p = printed.surface.points[i].head<2>();
    // The film image is half white at the edge.
    if (std::abs(p.x()) > 29 || std::abs(p.y()) > 19) continue;
    EXPECT_NEAR(colours[i].x(), (p.x() + 30) / 60, 0.01);
    EXPECT_NEAR(colours[i].y(), (20 - p.y()) / 40, 0.01);
    EXPECT_NEAR(colours[i].z(), 128 / 255.0, 0.01);
  }
}

TEST(Landed, TheFilmReproducesTheTexture) {
  const Printed printed;
  const auto film = FilmTexture::from_image(printed.film, printed.outline, 5000, {});
  ASSERT_TRUE(film);
  const auto landed =
      landed_texture(printed.model, printed.surface, printed.tiles, *film, 150, 100, {});
  ASSERT_TRUE(landed);
  ASSERT_EQ(landed->rgba.size(), 4U * 150 * 100);
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 150; ++x) {
      const std::uint8_t* p = &landed->rgba[4 * static_cast<std::size_t>(y * 150 + x)];
      ASSERT_EQ(p[3], 255) << x << ", " << y;
      if (x == 0 || y == 0 || x == 149 || y == 99) continue;
      ASSERT_NEAR(p[0], (x + 0.5) * 255 / 150, 3) << x << ", " << y;
      ASSERT_NEAR(p[1], (y + 0.5) * 255 / 100, 3) << x << ", " << y;
    }
  }
}

TEST(Landed, TextureIsWhiteAndTransparentWhereNothingLands) {
  Printed printed;
  std::erase_if(printed.tiles, [&](const auto& tile) { return tile.film_mm[0].x() < 0; });
  const auto film = FilmTexture::from_image(printed.film, printed.outline, 5000, {});
  ASSERT_TRUE(film);
  const auto landed =
      landed_texture(printed.model, printed.surface, printed.tiles, *film, 60, 40, {});
  ASSERT_TRUE(landed);
  for (const int y : {3, 20, 36}) {
    const std::uint8_t* left = &landed->rgba[4 * static_cast<std::size_t>(y * 60 + 5)];
    EXPECT_EQ(left[0], 255);
    EXPECT_EQ(left[3], 0);
    EXPECT_EQ(landed->rgba[4 * static_cast<std::size_t>(y * 60 + 55) + 3], 255);
  }
}

TEST(Landed, AModelWithoutUvsIsRefusedForATexture) {
  Printed printed;
  printed.model.corner_uvs.clear();
  const auto film = FilmTexture::from_image(printed.film, printed.outline, 5000, {});
  ASSERT_TRUE(film);
  const auto landed =
      landed_texture(printed.model, printed.surface, printed.tiles, *film, 60, 40, {});
  ASSERT_FALSE(landed);
  EXPECT_EQ(landed.error().code, Code::kFailedPrecondition);
}

TEST(FilmTexture, AnImageOfAnySizeIsFittedToTheFilm) {
  // 37 x 23 pixels over 80 x 60 mm do not have a whole number of dots per inch, so the image is
  // fitted to the film.
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder / "odd.png", smooth_texture(37, 23), 72));
  const auto film = FilmTexture::read(folder / "odd.png", rectangle(80, 60), {});
  ASSERT_TRUE(film);
  const Eigen::Vector3f middle = srgb_from_linear(film->at({0, 0}));
  EXPECT_NEAR(middle.x(), 18 / 37.0, 0.01);
  EXPECT_NEAR(middle.y(), 11 / 23.0, 0.01);
  EXPECT_NEAR(srgb_from_linear(film->at({-40, 30})).x(), 0, 0.01);
  EXPECT_NEAR(srgb_from_linear(film->at({40, -30})).y(), 22 / 23.0, 0.01);
}

std::set<std::array<int, 3>> colours_of(const RgbImage& image) {
  std::set<std::array<int, 3>> colours;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    colours.insert({image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]});
  }
  return colours;
}

TEST(Pictures, ShowTheObjectWithAndWithoutFilmFromAnySide) {
  Printed printed;
  const auto film = FilmTexture::from_image(printed.film, printed.outline, kPictureFilmSide_px, {});
  ASSERT_TRUE(film);
  const Pose X_FO(Eigen::AngleAxisd(1, Eigen::Vector3d::UnitX()));
  flow::FlowMap map;
  map.tiles = printed.tiles;
  map.surface.stretch.assign(printed.surface.points.size(), 1.5);
  const auto views = find_views(printed.surface, X_FO, map.tiles, {});
  const auto bare = find_views(printed.surface, X_FO, {}, {});
  ASSERT_TRUE(views && bare);
  const auto stretch = stretch_picture(*views, map.surface, {});
  ASSERT_TRUE(stretch);
  EXPECT_EQ(stretch->width, 1360);
  EXPECT_LT(stretch->height, 1800);
  const auto with = predicted_picture(*views, *film, {});
  const auto without = predicted_picture(*bare, *film, {});
  ASSERT_TRUE(with && without);
  EXPECT_GT(colours_of(*with).size(), 2000U);
  for (const auto& [r, g, b] : colours_of(*without)) {
    EXPECT_NEAR(r, g, 6) << "the picture of an object without film must be grey";
    EXPECT_NEAR(g, b, 10);
  }
}

TEST(Pictures, AreTheSameForAnyNumberOfThreads) {
  const Printed printed;
  flow::FlowMap map;
  map.tiles = printed.tiles;
  map.surface.stretch.assign(printed.surface.points.size(), 1.2);
  Context two;
  two.threads = 2;
  const auto by_one = find_views(printed.surface, Pose::Identity(), map.tiles, {});
  const auto by_two = find_views(printed.surface, Pose::Identity(), map.tiles, two);
  ASSERT_TRUE(by_one && by_two);
  const auto a = stretch_picture(*by_one, map.surface, {});
  const auto b = stretch_picture(*by_two, map.surface, two);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->rgb, b->rgb);
}

TEST(Pictures, AreDrawnEvenWithoutReachedOrFiniteValues) {
  const Printed printed;
  flow::FlowMap map;
  map.surface.stretch.assign(printed.surface.points.size(), std::nan(""));
  const auto views = find_views(printed.surface, Pose::Identity(), map.tiles, {});
  ASSERT_TRUE(views);
  EXPECT_TRUE(stretch_picture(*views, map.surface, {}));
}

TEST(Pictures, HaveAFewLabelsHoweverLargeTheStretch) {
  const Printed printed;
  flow::FlowMap map;
  map.tiles = printed.tiles;
  const auto views = find_views(printed.surface, Pose::Identity(), map.tiles, {});
  ASSERT_TRUE(views);
  const auto ink_of_labels = [&](double stretch) {
    map.surface.stretch.assign(printed.surface.points.size(), stretch);
    const auto sheet = stretch_picture(*views, map.surface, {});
    if (!sheet) return std::ptrdiff_t{0};
    constexpr int kLegendRows = 60;  // below the coloured bar, with margin
    std::ptrdiff_t ink = 0;
    for (int y = sheet->height - kLegendRows; y < sheet->height; ++y)
      for (int x = 0; x < sheet->width; ++x) ink += *sheet->at(x, y) < 100 ? 1 : 0;  // its red
    return ink;
  };
  const auto usual = ink_of_labels(1.5);
  EXPECT_GT(usual, 100);
  EXPECT_LT(ink_of_labels(5e6), 3 * usual);
}

}  // namespace
}  // namespace hydroprint::image
