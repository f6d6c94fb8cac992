#include "sim/image/texture/raster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace hydroprint::image {
namespace {

std::vector<int> visits(const std::vector<Corners>& triangles, const Window& window) {
  const int width = window.x1 - window.x0;
  std::vector<int> count(static_cast<std::size_t>(width) * (window.y1 - window.y0), 0);
  for (const auto& triangle : triangles) {
    for_each_sample(triangle, window, [&](int x, int y, const Eigen::Vector3d&) {
      ++count[static_cast<std::size_t>(y - window.y0) * width + (x - window.x0)];
    });
  }
  return count;
}

TEST(Raster, TrianglesOfARandomMeshVisitEachSampleExactlyOnce) {
  // A grid of jittered vertices, some of them exactly on samples, split along either diagonal.
  std::mt19937 random(7);
  std::uniform_real_distribution<double> jitter(-1.4, 1.4);
  constexpr int kCells = 24;
  std::vector<Eigen::Vector2d> points;
  for (int j = 0; j <= kCells; ++j) {
    for (int i = 0; i <= kCells; ++i) {
      const bool inner = i > 0 && j > 0 && i < kCells && j < kCells;
      Eigen::Vector2d p(8.0 * i, 8.0 * j);
      if (inner) p += Eigen::Vector2d(jitter(random), jitter(random));
      if (inner && (i + j) % 3 == 0) p = p.array().floor() + 0.5;
      points.push_back(p);
    }
  }
  std::vector<Corners> triangles;
  for (int j = 0; j < kCells; ++j) {
    for (int i = 0; i < kCells; ++i) {
      const int v = j * (kCells + 1) + i, w = v + kCells + 1;
      if ((i * 7 + j) % 2 == 0) {
        triangles.push_back({points[v], points[v + 1], points[w + 1]});
        triangles.push_back({points[w + 1], points[v], points[w]});  // the other orientation
      } else {
        triangles.push_back({points[v], points[v + 1], points[w]});
        triangles.push_back({points[v + 1], points[w], points[w + 1]});
      }
    }
  }
  for (const int count : visits(triangles, {0, 0, 8 * kCells, 8 * kCells})) ASSERT_EQ(count, 1);
}

TEST(Raster, ASliverFanCoversEachSampleOnce) {
  std::vector<Corners> fan;
  const Eigen::Vector2d centre(50.5, 50.5);
  constexpr int kBlades = 20000;
  const auto rim = [&](int i) {
    const double angle = 2 * M_PI * (i % kBlades) / kBlades;
    return Eigen::Vector2d(centre + 200 * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  };
  for (int i = 0; i < kBlades; ++i) fan.push_back({centre, rim(i), rim(i + 1)});
  for (const int count : visits(fan, {0, 0, 100, 100})) ASSERT_EQ(count, 1);
}

TEST(Raster, SamplesOnTheLowerRightEdgesAreLeftOut) {
  const std::vector<Corners> square = {
      Corners{Eigen::Vector2d(0.5, 0.5), Eigen::Vector2d(2.5, 0.5), Eigen::Vector2d(2.5, 2.5)},
      Corners{Eigen::Vector2d(0.5, 0.5), Eigen::Vector2d(2.5, 2.5), Eigen::Vector2d(0.5, 2.5)}};
  EXPECT_EQ(visits(square, {0, 0, 4, 4}),
            (std::vector<int>{1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
}

TEST(Raster, HugeTrianglesAreExactWithinTheWindow) {
  const double far = 3e9;
  const std::vector<Corners> halves = {
      Corners{Eigen::Vector2d(-far, -far), Eigen::Vector2d(far, -far), Eigen::Vector2d(far, far)},
      Corners{Eigen::Vector2d(-far, -far), Eigen::Vector2d(far, far), Eigen::Vector2d(-far, far)}};
  for (const int count : visits(halves, {-20, -20, 20, 20})) ASSERT_EQ(count, 1);
}

TEST(Raster, NanInfiniteAndFlatTrianglesHaveNoSamples) {
  const double nan = std::nan("");
  const std::vector<Corners> bad = {
      Corners{Eigen::Vector2d(nan, 0), Eigen::Vector2d(9, 0), Eigen::Vector2d(0, 9)},
      Corners{Eigen::Vector2d(0, 0), Eigen::Vector2d(HUGE_VAL, 0), Eigen::Vector2d(0, 9)},
      Corners{Eigen::Vector2d(0, 0), Eigen::Vector2d(1e300, 0), Eigen::Vector2d(0, 1e300)},
      Corners{Eigen::Vector2d(0, 0), Eigen::Vector2d(5, 5), Eigen::Vector2d(9, 9)}};
  for (const int count : visits(bad, {0, 0, 10, 10})) ASSERT_EQ(count, 0);
}

TEST(Raster, BarycentricCoordinatesMatchTheSample) {
  const Corners corners = {Eigen::Vector2d(1, 2), Eigen::Vector2d(40, 7), Eigen::Vector2d(11, 33)};
  int samples = 0;
  for_each_sample(corners, {0, 0, 50, 50}, [&](int x, int y, const Eigen::Vector3d& b) {
    const Eigen::Vector2d p = b[0] * corners[0] + b[1] * corners[1] + b[2] * corners[2];
    EXPECT_NEAR(b.sum(), 1, 1e-12);
    EXPECT_NEAR((p - Eigen::Vector2d(x + 0.5, y + 0.5)).norm(), 0, 1e-10);
    ++samples;
  });
  EXPECT_NEAR(samples, 579.5, 30);
}

}  // namespace
}  // namespace hydroprint::image
