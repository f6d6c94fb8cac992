#include "sim/ink/ink_field.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "tests/sim/ink/films.h"

namespace hydroprint::ink {
namespace {

using Eigen::Vector2d;
using Triangle = std::array<Vector2d, 3>;

InkField field_of(const film::Outline& outline, const std::function<double(const Vector2d&)>& t,
                  double cell_mm = kInkCell_mm) {
  return *InkField::from_function(ink_grid(outline, cell_mm), t);
}

/// A field whose cells are independent of each other, which is the hardest kind.
InkField noise(const film::Outline& outline, double cell_mm) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> amount(0, kMostInk);
  const InkGrid grid = ink_grid(outline, cell_mm);
  std::vector<double> means(grid.count());
  for (double& t : means) t = amount(random);
  return *InkField::from_means(grid, means);
}

double area_mm2(const Triangle& t) {
  const Vector2d b = t[1] - t[0], c = t[2] - t[0];
  return (b.x() * c.y() - b.y() * c.x()) / 2;
}

double mean(const InkField& field, const Triangle& t) { return field.mean(t[0], t[1], t[2]); }

/// Mean over the centroids of parts^2 congruent pieces of the triangle.
double sampled_mean(const InkField& field, const Triangle& t, int parts) {
  double sum = 0;
  for (int i = 0; i < parts; ++i) {
    for (int j = 0; i + j < parts; ++j) {
      for (const double third : {1 / 3.0, 2 / 3.0}) {
        const double b = (i + third) / parts, c = (j + third) / parts;
        if (b + c < 1) sum += field.at(t[0] + b * (t[1] - t[0]) + c * (t[2] - t[0]));
      }
    }
  }
  return sum / (static_cast<double>(parts) * parts);
}

std::vector<Triangle> random_triangles(double edge_mm, double reach_mm, int count) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-reach_mm, reach_mm), turn(0, 2 * std::numbers::pi),
      size(0.5, 1);
  std::vector<Triangle> out;
  for (int k = 0; k < count; ++k) {
    const Vector2d centre(place(random), place(random));
    const double angle = turn(random);
    Triangle t;
    for (int i = 0; i < 3; ++i) {
      const double at = angle + 2 * std::numbers::pi / 3 * i;
      t[i] = centre + size(random) * edge_mm / std::sqrt(3) * Vector2d(std::cos(at), std::sin(at));
    }
    out.push_back(t);
  }
  return out;
}

TEST(InkGrid, CoversTheBoundingBoxWithCellsOfAboutTheRequestedSize) {
  for (const char* film : {"A4", "123.4x10", "circle:77", "2000x2000"}) {
    const film::Outline outline = outline_of(film);
    const InkGrid grid = ink_grid(outline);
    const Vector2d size = grid.cell_mm.cwiseProduct(Vector2d(grid.columns, grid.rows));
    EXPECT_NEAR((size - outline.size_mm()).norm(), 0, 1e-9) << film;
    EXPECT_EQ(grid.low_mm, outline.min_mm) << film;
    EXPECT_LE(grid.count(), std::size_t{2048} * 2048) << film;
    if (outline.size_mm().maxCoeff() < 1000) {
      EXPECT_NEAR(grid.cell_mm.x(), kInkCell_mm, 0.04 * kInkCell_mm) << film;
      EXPECT_NEAR(grid.cell_mm.y(), kInkCell_mm, 0.04 * kInkCell_mm) << film;
    }
  }
  EXPECT_EQ(ink_grid(outline_of("10x10"), 1e9).count(), 1u);
  EXPECT_EQ(ink_grid(outline_of("10x10"), 1e-300).count(), std::size_t{2048} * 2048);
}

TEST(InkField, DefaultMeansNoInk) {
  const InkField none;
  EXPECT_EQ(none.at({0, 0}), 0);
  EXPECT_EQ(none.mean({0, 0}, {10, 0}, {0, 10}), 0);
  EXPECT_EQ(none.total_mm2(), 0);
}

TEST(InkField, InvalidAmountsAreRefusedByTheirCell) {
  const InkGrid grid = ink_grid(outline_of("10x10"), 5);
  ASSERT_EQ(grid.count(), 4u);
  for (const double bad : {-1e-9, 4.0001, std::nan(""), std::numeric_limits<double>::infinity()}) {
    const auto field = InkField::from_means(grid, {0, 4, bad, 0});
    ASSERT_FALSE(field) << bad;
    EXPECT_EQ(field.error().code, Code::kInvalidArgument);
    EXPECT_NE(field.error().message.find("(0, 1)"), std::string::npos) << field.error().message;
    EXPECT_FALSE(InkField::from_function(grid, [&](const Vector2d&) { return bad; }));
  }
  EXPECT_FALSE(InkField::from_means(grid, {0, 0, 0}));
  EXPECT_FALSE(InkField::from_means(grid, {}));
  EXPECT_TRUE(InkField::from_means(grid, {0, 1, 2, 4}));
}

TEST(InkField, CellsLieFromTheLowerLeft) {
  const auto field =
      *InkField::from_means(ink_grid(outline_of("10x20"), 5), {0, 1, 2, 3, 4, 0, 0, 0});
  EXPECT_EQ(field.at({-2.5, -7.5}), 0);
  EXPECT_EQ(field.at({2.5, -7.5}), 1);
  EXPECT_EQ(field.at({-2.5, -2.5}), 2);
  EXPECT_EQ(field.at({2.5, -2.5}), 3);
  EXPECT_EQ(field.at({-2.5, 2.5}), 4);
  EXPECT_DOUBLE_EQ(field.at({0, -5}), 1.5) << "amounts are interpolated bilinearly";
  EXPECT_EQ(field.at({5, -10}), 1) << "the corner belongs to the film";
  EXPECT_EQ(field.at({5.001, -10}), 0) << "there is no ink outside the film";
  EXPECT_DOUBLE_EQ(field.total_mm2(), 250);
}

TEST(InkField, LinearInkIsExactAtEveryPointAndOverEveryTriangle) {
  const auto t = [](const Vector2d& p) { return 2 + 0.011 * p.x() - 0.006 * p.y(); };
  const InkField field = field_of(outline_of("210x210"), t);
  for (const double edge_mm : {1e-3, 0.2, 1.0, 4.0, 15.0}) {
    for (const Triangle& triangle : random_triangles(edge_mm, 90, 200)) {
      EXPECT_NEAR(field.at(triangle[0]), t(triangle[0]), 1e-12);
      const Vector2d centroid = (triangle[0] + triangle[1] + triangle[2]) / 3;
      EXPECT_NEAR(mean(field, triangle), t(centroid), 1e-7 * std::min(1.0, 1e-3 / edge_mm));
    }
  }
}

TEST(InkField, MeanIsThatOfManySamples) {
  const InkField field = noise(outline_of("100x80"), 0.5);
  for (const double edge_mm : {0.2, 0.7, 3.0, 15.0}) {
    for (const Triangle& triangle : random_triangles(edge_mm, 30, 20)) {
      EXPECT_NEAR(mean(field, triangle), sampled_mean(field, triangle, 300), 1e-3) << edge_mm;
    }
  }
}

TEST(InkField, ThereIsNoInkBeyondTheFilm) {
  const InkField field = field_of(outline_of("20x20"), [](const Vector2d&) { return 3; });
  EXPECT_NEAR(field.mean({5, -5}, {15, -5}, {5, 5}), 3 * 0.75, 1e-12)
      << "a quarter of the triangle lies beyond the film";
  EXPECT_NEAR(field.mean({-40, -40}, {40, -40}, {0, 40}), 3 * 400 / 3200.0, 1e-12)
      << "the film lies within the triangle";
  EXPECT_EQ(field.mean({11, 0}, {15, 0}, {12, 4}), 0);
  EXPECT_NEAR(field.mean({-15, -30}, {15, 0}, {-15, 30}), 3 * 375 / 900.0, 1e-12);
}

TEST(InkField, TrianglesThatCoverTheFilmContainAllItsInk) {
  const film::Outline outline = outline_of("97.3x61.9");
  for (const double cell_mm : {0.5, 3.0, 100.0}) {
    const InkField field = noise(outline, cell_mm);
    std::mt19937 random(3);
    for (int trial = 0; trial < 20; ++trial) {
      // A fan of triangles around a random point of the film. Random points divide the film's
      // edges.
      std::uniform_real_distribution<double> share(0.05, 0.95);
      const Vector2d hub =
          outline.min_mm + outline.size_mm().cwiseProduct(Vector2d(share(random), share(random)));
      double ink = 0, area = 0;
      for (int side = 0; side < 4; ++side) {
        const Vector2d a = outline.polygon[side], c = outline.polygon[(side + 1) % 4];
        const Vector2d b = a + share(random) * (c - a);
        for (const Triangle& triangle : {Triangle{hub, a, b}, Triangle{hub, b, c}}) {
          ink += area_mm2(triangle) * mean(field, triangle);
          area += area_mm2(triangle);
        }
      }
      EXPECT_NEAR(area, outline.size_mm().prod(), 1e-9);
      EXPECT_NEAR(ink, field.total_mm2(), 1e-12 * field.total_mm2()) << cell_mm;
    }
  }
}

TEST(InkField, PartsOfATriangleAddUpToIt) {
  const InkField field = noise(outline_of("100x100"), 0.5);
  for (const Triangle& whole : random_triangles(20, 45, 50)) {
    double ink = 0;
    const int parts = 40;
    const auto corner = [&](int i, int j) -> Vector2d {
      return whole[0] + (whole[1] - whole[0]) * i / parts + (whole[2] - whole[0]) * j / parts;
    };
    for (int i = 0; i < parts; ++i) {
      for (int j = 0; i + j < parts; ++j) {
        ink += field.mean(corner(i, j), corner(i + 1, j), corner(i, j + 1));
        if (i + j + 1 == parts) continue;
        ink += field.mean(corner(i + 1, j + 1), corner(i, j + 1), corner(i + 1, j));
      }
    }
    EXPECT_NEAR(ink / (parts * parts), mean(field, whole), 1e-9);
  }
}

TEST(InkField, MeanDoesNotDependOnOrientationOrFirstCorner) {
  const InkField field = noise(outline_of("100x100"), 0.5);
  for (const Triangle& t : random_triangles(3, 55, 100)) {
    EXPECT_NEAR(field.mean(t[0], t[1], t[2]), field.mean(t[0], t[2], t[1]), 1e-11);
    EXPECT_NEAR(field.mean(t[0], t[1], t[2]), field.mean(t[1], t[2], t[0]), 1e-11);
  }
}

TEST(InkField, EdgesAlongTheGridLoseNothing) {
  const InkField field = noise(outline_of("10x10"), 0.5);
  // Squares from cell centre to cell centre and from cell edge to cell edge, split along either
  // diagonal.
  for (const double from : {-4.75, -5.0, 0.0}) {
    const Vector2d a(from, from), b(from + 4, from), c(from + 4, from + 4), d(from, from + 4);
    const double whole = field.mean(a, b, c) + field.mean(a, c, d);
    EXPECT_NEAR(whole, field.mean(a, b, d) + field.mean(b, c, d), 1e-12);
  }
}

TEST(InkField, ARingOfInkIsAtItsPlace) {
  const auto ring = [](const Vector2d& p) { return p.norm() > 20 && p.norm() < 30 ? 2.0 : 0.0; };
  const InkField field = field_of(outline_of("circle:105"), ring);
  EXPECT_EQ(field.at({25, 0}), 2);
  EXPECT_EQ(field.at({0, -15}), 0);
  EXPECT_NEAR(field.total_mm2(), 2 * std::numbers::pi * (900 - 400), 1);
  EXPECT_EQ(field.mean({22, 0}, {28, 0}, {25, 3}), 2);
}

TEST(InkField, FlatTinyAndWildTrianglesGiveAnAmountOfInk) {
  const InkField field = noise(outline_of("100x100"), 0.5);
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  const std::vector<Triangle> triangles = {
      {Vector2d(1, 1), Vector2d(1, 1), Vector2d(1, 1)},
      {Vector2d(1, 1), Vector2d(2, 2), Vector2d(3, 3)},
      {Vector2d(1, 1), Vector2d(40, 1), Vector2d(20, 1)},
      {Vector2d(1, 1), Vector2d(40, 1), Vector2d(20, 1 + 1e-7)},
      {Vector2d(1, 1), Vector2d(40, 33), Vector2d(20, 17 + 1e-13)},
      {Vector2d(1, 1), Vector2d(1 + 1e-9, 1), Vector2d(1, 1 + 1e-9)},
      {Vector2d(-1e150, 0), Vector2d(1e150, 1), Vector2d(0, 1e150)},
      {Vector2d(-1e300, 0), Vector2d(1e300, 1), Vector2d(0, 1e300)},
      {Vector2d(0, 1), Vector2d(1e300, 1 + 1e-15), Vector2d(1, 2)},
      {Vector2d(nan, 0), Vector2d(1, 0), Vector2d(0, 1)},
      {Vector2d(inf, 0), Vector2d(1, 0), Vector2d(0, 1)},
      {Vector2d(inf, -inf), Vector2d(nan, 0), Vector2d(0, inf)},
  };
  for (const Triangle& t : triangles) {
    const double amount = mean(field, t);
    EXPECT_TRUE(amount >= 0 && amount <= kMostInk) << t[0].transpose() << ", " << t[1].transpose();
  }
  EXPECT_EQ(field.mean({1, 1}, {1, 1}, {1, 1}), field.at({1, 1}));
  EXPECT_EQ(field.at({nan, 0}), 0);
  EXPECT_EQ(field.at({0, -inf}), 0);
}

}  // namespace
}  // namespace hydroprint::ink
