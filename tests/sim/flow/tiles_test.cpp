#include "sim/flow/tiles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "sim/flow/flow_map.h"
#include "sim/sample/icosphere.h"
#include "tests/sim/support/bodies.h"
#include "tests/sim/support/dips.h"
#include "tests/support/exact_sphere.h"

namespace hydroprint::flow {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::DipSetting;
using testing::SolvedDip;

double cross(const Vector2d& u, const Vector2d& v) { return u.x() * v.y() - u.y() * v.x(); }

double area_of(const MappedTriangle& tile) {
  return 0.5 * cross(tile.film_mm[1] - tile.film_mm[0], tile.film_mm[2] - tile.film_mm[0]);
}

/// Number of tiles that cover the film, sampled near the middles of square cells.
class Raster {
 public:
  Raster(const film::Outline& film, double cell_mm) : cell_mm_(cell_mm), low_mm_(film.min_mm) {
    columns_ = static_cast<int>(std::ceil(film.size_mm().x() / cell_mm));
    rows_ = static_cast<int>(std::ceil(film.size_mm().y() / cell_mm));
    count_.assign(static_cast<std::size_t>(columns_) * rows_, 0);
  }

  void draw(const MappedTriangle& tile) {
    std::array<Vector2d, 3> p;
    for (int i = 0; i < 3; ++i) p[i] = (tile.film_mm[i] - low_mm_) / cell_mm_;
    const Vector2d low = p[0].cwiseMin(p[1]).cwiseMin(p[2]);
    const Vector2d high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
    for (int y = std::max(0, static_cast<int>(low.y()) - 1);
         y < std::min(rows_, static_cast<int>(high.y()) + 2); ++y) {
      for (int x = std::max(0, static_cast<int>(low.x()) - 1);
           x < std::min(columns_, static_cast<int>(high.x()) + 2); ++x) {
        // Not exactly the middle, so that the sample is not on the edge of a tile.
        const Vector2d at(x + 0.50137, y + 0.49771);
        bool inside = true;
        for (int i = 0; i < 3; ++i) {
          inside = inside && cross(p[(i + 1) % 3] - p[i], at - p[i]) > 0;
        }
        count_[static_cast<std::size_t>(y) * columns_ + x] += inside;
      }
    }
  }

  template <class Visit>
  void for_each(Visit&& visit) const {
    for (int y = 0; y < rows_; ++y) {
      for (int x = 0; x < columns_; ++x) {
        visit(Vector2d(low_mm_ + cell_mm_ * Vector2d(x + 0.5, y + 0.5)),
              count_[static_cast<std::size_t>(y) * columns_ + x]);
      }
    }
  }

  /// Area covered by tiles, and the area of their overlaps.
  [[nodiscard]] std::pair<double, double> covered_and_doubled() const {
    double covered = 0, doubled = 0;
    for (const int n : count_) {
      covered += n > 0;
      doubled += std::max(0, n - 1);
    }
    return {covered * cell_mm_ * cell_mm_, doubled * cell_mm_ * cell_mm_};
  }

 private:
  double cell_mm_;
  Vector2d low_mm_;
  int columns_ = 0, rows_ = 0;
  std::vector<int> count_;
};

FlowMap tiled(const SolvedDip& dip, const MapOptions& options = {}) {
  Context context;
  context.threads = 2;
  return make_flow_map(dip.surface, dip.body, dip.field, {}, options, context).value();
}

/// Traces the film at random points of random tiles and compares it with the tile's interpolation.
void expect_linear(const SolvedDip& dip, const FlowMap& map, const MapOptions& options,
                   double most_off = 0.002, double worst_mm = 0.5) {
  std::mt19937 random(33);
  std::uniform_real_distribution<double> unit(0, 1);
  const int samples = 3000;
  int off = 0, lost = 0;
  double most = 0;
  const waterline::Motion straight;
  const Landings landings(dip.body, straight);
  for (int i = 0; i < samples; ++i) {
    const MappedTriangle& tile = map.tiles[random() % map.tiles.size()];
    double a = unit(random), b = unit(random);
    if (a + b > 1) {
      a = 1 - a;
      b = 1 - b;
    }
    const Vector3d share(1 - a - b, a, b);
    Vector2d film = Vector2d::Zero();
    Vector3d barycentric = Vector3d::Zero();
    for (int k = 0; k < 3; ++k) {
      film += share[k] * tile.film_mm[k];
      barycentric += share[k] * tile.barycentric[k].cast<double>();
    }
    const auto traced = trace_back(dip.field, landings.on(tile.triangle, barycentric));
    if (!traced) {
      ++lost;
      continue;
    }
    const double error = (*traced - film).norm();
    most = std::max(most, error);
    off += error > 2 * options.tolerance_mm;
  }
  EXPECT_LE(off, most_off * samples)
      << "too many errors above twice the tolerance; largest error in mm: " << most;
  EXPECT_LE(lost, samples / 500) << "too many points of tiles have no film";
  EXPECT_LT(most, worst_mm);
}

void expect_sound(const SolvedDip& dip, const FlowMap& map, double overlap = 1e-3) {
  ASSERT_FALSE(map.tiles.empty());
  double area = 0;
  Raster raster(dip.field.outline, 0.1);
  for (const MappedTriangle& tile : map.tiles) {
    EXPECT_GT(area_of(tile), 0) << "a tile is clockwise on the film";
    area += area_of(tile);
    for (int i = 0; i < 3; ++i) {
      EXPECT_TRUE(tile.film_mm[i].allFinite());
      EXPECT_TRUE(film::contains(dip.field.outline, tile.film_mm[i]));
      EXPECT_NEAR(tile.barycentric[i].sum(), 1, 1e-5);
      EXPECT_GE(tile.barycentric[i].minCoeff(), 0);
    }
    raster.draw(tile);
  }
  const auto [covered, doubled] = raster.covered_and_doubled();
  EXPECT_LT(doubled / covered, overlap) << "tiles overlap";
  EXPECT_NEAR(area / covered, 1, overlap + 1e-3);
}

TEST(Tiles, OfASphereCoverTheDiscThatLandsOnIt) {
  DipSetting setting;
  setting.film = testing::round_film(60, 90);
  setting.depth_mm = 25 * (1 - std::cos(2.1));
  const SolvedDip dip = testing::solve_dip(sample::icosphere(25, 5), setting);
  const MapOptions options;
  const FlowMap map = tiled(dip, options);
  expect_sound(dip, map);
  expect_linear(dip, map, options);
  const double radius = exact::film_radius_mm(25, 60, 2.1);
  Raster raster(setting.film, 0.2);
  double area = 0;
  for (const MappedTriangle& tile : map.tiles) {
    raster.draw(tile);
    area += area_of(tile);
  }
  raster.for_each([&](const Vector2d& p, int count) {
    if (p.norm() < radius - 0.15) {
      EXPECT_GE(count, 1) << "hole at " << p.transpose();
    }
    if (p.norm() > radius + 0.15) {
      EXPECT_EQ(count, 0) << "beyond, at " << p.transpose();
    }
  });
  EXPECT_NEAR(area / (std::numbers::pi * radius * radius), 1, 5e-3);
}

TEST(Tiles, OfTwoFeetAndTheirBridgeOverlapLittle) {
  DipSetting setting;
  setting.film = testing::film_of("110x80");
  setting.depth_mm = 24;
  const SolvedDip dip =
      testing::solve_dip(testing::blocks({-20, -8, 8, 20}, {-9, 9}, {0, 14, 26},
                                         [](int i, int, int k) { return k == 1 || i != 1; }),
                         setting);
  const MapOptions options;
  const FlowMap map = tiled(dip, options);
  expect_sound(dip, map);
  // At sharp upright edges, the pull of eq. (1) turns abruptly by a right angle, so the map has a
  // kink there.
  expect_linear(dip, map, options, 0.15, 0.4);
}

TEST(Tiles, OfASphereOnAStalkOverlapLittle) {
  // The stalk opens a hole in the film; the overhanging sphere then carries film down around the
  // stalk.
  DipSetting setting;
  setting.film = testing::film_of("110x100");
  setting.depth_mm = 34;
  setting.schedule.swept_mm = 1.3;  // coarse steps, because this test is about tiles
  const SolvedDip dip =
      testing::solve_dip(testing::together({testing::moved(testing::cylinder(4, 20, 48), {3, 2, 0}),
                                            testing::moved(sample::icosphere(18, 4), {0, 0, 30})}),
                         setting);
  const MapOptions options;
  const FlowMap map = tiled(dip, options);
  expect_sound(dip, map, 0.015);
  expect_linear(dip, map, options, 0.02, 0.25);
}

TEST(Tiles, RespectAFinerTolerance) {
  DipSetting setting;
  setting.film = testing::film_of("80x80");
  setting.depth_mm = 20;
  const SolvedDip dip =
      testing::solve_dip(testing::moved(sample::icosphere(16, 4), {4, -3, 0}), setting);
  MapOptions options;
  const std::size_t coarse = tiled(dip, options).tiles.size();
  options.tolerance_mm = 0.004;
  const FlowMap map = tiled(dip, options);
  EXPECT_GT(map.tiles.size(), coarse);
  expect_linear(dip, map, options);
}

TEST(Tiles, CarryTheTimeOfContact) {
  DipSetting setting;
  setting.film = testing::film_of("80x80");
  setting.depth_mm = 12;
  const SolvedDip dip = testing::solve_dip(sample::icosphere(16, 3), setting);
  MapOptions options;
  options.dip_speed_mm_per_s = 2.5;
  const waterline::Motion straight;
  const Landings landings(dip.body, straight);
  for (const MappedTriangle& tile : tiled(dip, options).tiles) {
    for (int i = 0; i < 3; ++i) {
      const Landing landing = landings.on(tile.triangle, tile.barycentric[i].cast<double>());
      EXPECT_NEAR(tile.contact_time_s[i], landing.immersion_mm / 2.5, 1e-5);
    }
  }
}

TEST(Tiles, AreTheSameForAnyNumberOfThreads) {
  DipSetting setting;
  setting.film = testing::film_of("80x80");
  setting.depth_mm = 15;
  const SolvedDip dip = testing::solve_dip(testing::torus(18, 6, 48, 24), setting);
  const auto run = [&](int threads) {
    Context context;
    context.threads = threads;
    return make_flow_map(dip.surface, dip.body, dip.field, {}, {}, context).value();
  };
  const FlowMap one = run(1), three = run(3);
  ASSERT_EQ(one.tiles.size(), three.tiles.size());
  for (std::size_t i = 0; i < one.tiles.size(); ++i) {
    EXPECT_EQ(one.tiles[i].film_mm, three.tiles[i].film_mm);
    EXPECT_EQ(one.tiles[i].triangle, three.tiles[i].triangle);
  }
}

}  // namespace
}  // namespace hydroprint::flow
