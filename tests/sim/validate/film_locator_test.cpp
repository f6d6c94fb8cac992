#include "sim/validate/film_locator.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hydroprint::validate {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// An upright square of 10 mm. The film on a point (x, z) of the square is from (2 x, 2 z).
mesh::Surface upright_square() {
  mesh::Surface surface;
  surface.points = {{0, 0, 0}, {10, 0, 0}, {10, 0, 10}, {0, 0, 10}};
  surface.triangles = {{0, 1, 2}, {0, 2, 3}};
  return surface;
}

flow::MappedTriangle whole(const mesh::Surface& surface, int triangle, float time_s) {
  flow::MappedTriangle tile;
  tile.triangle = triangle;
  for (int i = 0; i < 3; ++i) {
    const Vector3d& p = surface.points[surface.triangles[triangle][i]];
    tile.film_mm[i] = Vector2d(2 * p.x(), 2 * p.z());
    tile.barycentric[i] = Eigen::Vector3f::Unit(i);
    tile.contact_time_s[i] = time_s;
  }
  return tile;
}

TEST(FilmLocator, FindsWhereEachPointOfTheFilmLands) {
  const mesh::Surface surface = upright_square();
  const std::vector tiles = {whole(surface, 0, 1), whole(surface, 1, 1)};
  const FilmLocator locator(surface, tiles);
  for (double x = 0.3; x < 20; x += 1.7) {
    for (double y = 0.2; y < 20; y += 1.3) {
      const auto place = locator.at({x, y});
      ASSERT_TRUE(place);
      EXPECT_LT((*place - Vector3d(x / 2, 0, y / 2)).norm(), 1e-12);
    }
  }
}

TEST(FilmLocator, FilmBesideTheTilesLandsNowhereUnlessItIsVeryClose) {
  const mesh::Surface surface = upright_square();
  const std::vector tiles = {whole(surface, 0, 1), whole(surface, 1, 1)};
  const FilmLocator locator(surface, tiles);
  EXPECT_FALSE(locator.at({-1, 5}));
  EXPECT_FALSE(locator.at({5, 20.2}));
  EXPECT_FALSE(locator.at({1e6, -1e6}));
  EXPECT_FALSE(locator.at(Vector2d::Constant(std::nan(""))));
  const auto beside = locator.at({5, 20.05});
  ASSERT_TRUE(beside);
  EXPECT_LT((*beside - Vector3d(2.5, 0, 10)).norm(), 1e-12);
  const std::vector<flow::MappedTriangle> none;
  EXPECT_FALSE(FilmLocator(surface, none).at({0, 0}));
}

TEST(FilmLocator, FilmThatHasLandedStays) {
  mesh::Surface surface = upright_square();
  for (const Vector3d& p : upright_square().points) surface.points.push_back(p + Vector3d(0, 7, 0));
  surface.triangles.push_back({4, 5, 6});
  for (const bool second_is_first : {false, true}) {
    std::vector tiles = {whole(surface, 0, 3), whole(surface, 2, second_is_first ? 2 : 4)};
    EXPECT_EQ(FilmLocator(surface, tiles).at({12, 4})->y(), second_is_first ? 7 : 0);
  }
}

}  // namespace
}  // namespace hydroprint::validate
