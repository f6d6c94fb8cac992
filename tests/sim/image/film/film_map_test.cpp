#include "sim/image/film/film_map.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>

#include "sim/image/film/stretch.h"
#include "tests/sim/image/scenes.h"

namespace hydroprint::image {
namespace {

using namespace testing;

/// A plate at z = 7 whose film is stretched by 3 along x and by 2 along y.
struct Scene {
  mesh::Surface surface;
  flow::FlowMap map;
};

Scene drawn_out() {
  Scene scene;
  mesh::Model model = plate(-30, -20, 30, 20, 6, 4);
  for (auto& v : model.vertices) v.z() = 7;
  scene.surface = surface_of(model);
  const auto film = [](const Eigen::Vector3d& p) {
    return Eigen::Vector2d(p.x() / 3 + 2, p.y() / 2 - 1);
  };
  scene.map.tiles = tiles_of(scene.surface, film);
  for (auto& tile : scene.map.tiles) {
    for (int i = 0; i < 3; ++i) {
      tile.contact_time_s[i] = static_cast<float>(4 + tile.film_mm[i].x() / 10);
    }
  }
  for (const auto& p : scene.surface.points) {
    scene.map.surface.film_mm.push_back(film(p));
    scene.map.surface.contact_time_s.push_back(0);
    scene.map.surface.stretch.push_back(3);
    scene.map.surface.least_stretch.push_back(2);
  }
  return scene;
}

TEST(FilmMap, HoldsTheContactPointOfEachCellsCentreAndNanElsewhere) {
  const Scene scene = drawn_out();
  const auto map = film_map(scene.surface, scene.map, rectangle(40, 30), 1, {});
  ASSERT_TRUE(map);
  ASSERT_EQ(map->grid.columns, 40);
  ASSERT_EQ(map->grid.rows, 30);
  for (int j = 0; j < 30; ++j) {
    for (int i = 0; i < 40; ++i) {
      const double x = -20 + i + 0.5, y = 15 - j - 0.5;
      const std::size_t cell = static_cast<std::size_t>(j) * 40 + i;
      const bool lands = std::abs(x - 2) < 10 && std::abs(y + 1) < 10;
      ASSERT_EQ(std::isfinite(map->time_s[cell]), lands) << x << ", " << y;
      ASSERT_EQ(map->contact_mm[cell].allFinite(), lands);
      ASSERT_EQ(std::isfinite(map->stretch[cell]), lands);
      if (!lands) continue;
      EXPECT_NEAR(map->contact_mm[cell].x(), 3 * (x - 2), 1e-4);
      EXPECT_NEAR(map->contact_mm[cell].y(), 2 * (y + 1), 1e-4);
      EXPECT_NEAR(map->contact_mm[cell].z(), 7, 1e-4);
      EXPECT_NEAR(map->time_s[cell], 4 + x / 10, 1e-5);
      EXPECT_NEAR(map->stretch[cell], 3, 1e-5);
    }
  }
}

TEST(FilmMap, TheEarliestContactCounts) {
  Scene scene = drawn_out();
  auto late = scene.map.tiles;
  for (auto& tile : late) {
    tile.contact_time_s.fill(100);
    for (auto& p : tile.film_mm) p.x() = -p.x();
  }
  late.insert(late.end(), scene.map.tiles.begin(), scene.map.tiles.end());
  scene.map.tiles = late;
  const auto map = film_map(scene.surface, scene.map, rectangle(40, 30), 1, {});
  ASSERT_TRUE(map);
  EXPECT_NEAR(map->time_s[15 * 40 + 20], 4.05, 1e-5);  // (0.5, -0.5) mm: covered by both plates
  EXPECT_NEAR(map->time_s[15 * 40 + 9], 100, 1e-4);    // (-10.5, -0.5) mm: only by the later one
}

TEST(FilmMap, AnExrKeepsNamesAndValues) {
  const TemporaryFolder folder;
  const Scene scene = drawn_out();
  const auto map = film_map(scene.surface, scene.map, rectangle(40, 30), 1, {});
  ASSERT_TRUE(map);
  ASSERT_TRUE(write_film_map_exr(folder / "film_map.exr", *map));
  const auto input = OIIO::ImageInput::open((folder / "film_map.exr").string());
  ASSERT_TRUE(input);
  const OIIO::ImageSpec& spec = input->spec();
  ASSERT_EQ(spec.nchannels, 5);
  EXPECT_EQ(spec.format, OIIO::TypeDesc::FLOAT);
  EXPECT_EQ(std::string(spec.get_string_attribute("compression")), "zip");
  std::vector<float> values(5 * map->time_s.size());
  ASSERT_TRUE(input->read_image(0, 0, 0, 5, OIIO::TypeDesc::FLOAT, values.data()));
  const std::size_t cell = 15 * 40 + 25;
  for (const auto& [name, value] : {std::pair<const char*, float>{"X", map->contact_mm[cell].x()},
                                    {"Y", map->contact_mm[cell].y()},
                                    {"Z", map->contact_mm[cell].z()},
                                    {"T", map->time_s[cell]},
                                    {"stretch", map->stretch[cell]}}) {
    const int channel = spec.channelindex(name);
    ASSERT_GE(channel, 0) << name;
    EXPECT_EQ(values[5 * cell + static_cast<std::size_t>(channel)], value) << name;
    EXPECT_TRUE(std::isnan(values[static_cast<std::size_t>(channel)])) << name;
  }
}

TEST(FilmMap, RefusesCellsOutOfRange) {
  const Scene scene = drawn_out();
  for (const double cell_mm : {0.0, -1.0, 0.01, 31.0, std::nan("")}) {
    const auto map = film_map(scene.surface, scene.map, rectangle(40, 30), cell_mm, {});
    ASSERT_FALSE(map) << cell_mm;
    EXPECT_EQ(map.error().code, Code::kOutOfRange);
  }
}

TEST(TileStretch, IsTheTilesOwnIfTheSurfaceHasNone) {
  Scene scene = drawn_out();
  EXPECT_NEAR(tile_stretch(scene.surface, scene.map.surface, scene.map.tiles[0])[1], 3, 1e-12);
  scene.map.surface.stretch.assign(scene.surface.points.size(), std::nan(""));
  for (const auto& tile : scene.map.tiles) {
    for (const double s : tile_stretch(scene.surface, scene.map.surface, tile)) {
      EXPECT_NEAR(s, 3, 1e-9);
    }
  }
}

}  // namespace
}  // namespace hydroprint::image
