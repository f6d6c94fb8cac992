#include "sim/waterline/slicer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "sim/sample/icosphere.h"
#include "sim/waterline/cross_section.h"
#include "tests/sim/support/bodies.h"

namespace hydroprint::waterline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
constexpr double kDegree_rad = std::numbers::pi / 180;

bool is_closed(const Contour& contour) {
  for (std::size_t i = 0; i < contour.size(); ++i) {
    if ((contour[i].b_mm - contour[(i + 1) % contour.size()].a_mm).norm() > 1e-9) return false;
  }
  return !contour.empty();
}

double area_of(const Contour& contour) {
  std::vector<Vector2d> points;
  for (const Segment& s : contour) points.push_back(s.a_mm);
  return signed_area(points);
}

double area_of(const CrossSection& section) {
  double area = 0;
  for (const Loop& loop : section) area += signed_area(loop.points_mm);
  return area;
}

/// Half of a pipe without thickness: the half of a cylinder around the z axis on the side of +x.
mesh::Model half_pipe(double radius_mm, double height_mm, int segments) {
  mesh::Model model;
  model.path = "half pipe";
  for (int s = 0; s <= segments; ++s) {
    const double angle = std::numbers::pi * (1.0 * s / segments - 0.5);
    for (const double z : {0.0, height_mm}) {
      model.vertices.emplace_back(radius_mm * std::cos(angle), radius_mm * std::sin(angle), z);
    }
  }
  for (int s = 0; s < segments; ++s) {
    model.triangles.emplace_back(2 * s, 2 * s + 2, 2 * s + 3);
    model.triangles.emplace_back(2 * s, 2 * s + 3, 2 * s + 1);
  }
  return model;
}

TEST(Slicer, CutOfABoxIsItsOutlineWithTheSolidOnTheLeft) {
  const Body body = testing::body_of(testing::box({-3, -5, 0}, {7, 5, 8}));
  const Slicer slicer(body);
  // Some cuts are at the heights of vertices.
  for (const double z : {0.001, 1.0, 2.0, 4.0, 7.3, 7.999}) {
    const auto contours = slicer.cut(z);
    ASSERT_EQ(contours.size(), 1U) << z;
    EXPECT_TRUE(is_closed(contours[0]));
    EXPECT_NEAR(area_of(contours[0]), 100, 1e-9);
    for (const Segment& s : contours[0]) {
      for (const auto& [p, u] : {std::pair{s.a_mm, s.pull_a}, std::pair{s.b_mm, s.pull_b}}) {
        EXPECT_NEAR(u.norm(), 1, 1e-12);  // the pull of a vertical wall is tan 45 degrees
        EXPECT_GT(u.dot(Vector2d(2, 0) - p), 0) << "the pull must point towards the object";
      }
    }
  }
}

TEST(Slicer, OutsideTheBodyThereIsNoCut) {
  const Body body = testing::body_of(testing::box({0, 0, 0}, {4, 4, 8}));
  const Slicer slicer(body);
  EXPECT_TRUE(slicer.cut(0).empty());
  EXPECT_TRUE(slicer.cut(-1).empty());
  EXPECT_TRUE(slicer.cut(8.0001).empty());
  EXPECT_TRUE(slicer.cut(1e6).empty());
}

TEST(Slicer, CutOfASphereIsACirclePulledByTheTangentOfHalfTheta) {
  const double radius = 20;
  const Body body = testing::body_of(sample::icosphere(radius, 5));
  const Slicer slicer(body);
  for (const double degrees : {5.0, 30.0, 60.0, 90.0, 120.0, 150.0, 165.0}) {
    const double theta = degrees * kDegree_rad;
    const auto contours = slicer.cut(radius * (1 - std::cos(theta)));
    ASSERT_EQ(contours.size(), 1U);
    ASSERT_TRUE(is_closed(contours[0]));
    const double circle = std::numbers::pi * std::pow(radius * std::sin(theta), 2);
    EXPECT_NEAR(area_of(contours[0]) / circle, 1, 5e-3 / std::sin(theta));
    for (const Segment& s : contours[0]) {
      const Vector2d expected = -std::tan(theta / 2) * s.a_mm.normalized();
      EXPECT_LT((s.pull_a - expected).norm(), 0.01 * std::tan(theta / 2) + 2e-3) << degrees;
    }
  }
}

TEST(Slicer, SurfacesBeyond170DegreesPullNoHarderThanAt170) {
  const Body body = testing::body_of(sample::icosphere(20, 5));
  const double most = std::tan(85 * kDegree_rad);
  for (const double degrees : {171.0, 175.0, 178.0}) {
    for (const Contour& contour : Slicer(body).cut(20 * (1 - std::cos(degrees * kDegree_rad)))) {
      for (const Segment& s : contour) {
        EXPECT_LT(s.pull_a.norm(), most * (1 + 1e-12));
        EXPECT_GT(s.pull_a.norm(), 0.9 * most);
      }
    }
  }
}

TEST(Slicer, CutsOfIrregularBodiesAreClosedAtEveryLevel) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shake(-0.4, 0.4);
  mesh::Model model = testing::torus(20, 8, 40, 20);
  for (Vector3d& v : model.vertices) v += Vector3d(shake(random), shake(random), shake(random));
  const Body body = testing::body_of(model);
  const Slicer slicer(body);
  std::uniform_real_distribution<double> level(0, body.height_mm);
  for (int i = 0; i < 300; ++i) {
    const double z = i < 150 ? level(random) : body.points_mm[static_cast<std::size_t>(i)].z();
    for (const Contour& contour : slicer.cut(z)) EXPECT_TRUE(is_closed(contour)) << z;
  }
}

TEST(Slicer, InvertedFacesAreTurnedOverWithTheirPull) {
  const Body body = testing::body_of(sample::icosphere(20, 4));
  Body spoilt = body;
  std::mt19937 random(3);
  for (std::size_t t = 0; t < spoilt.triangles.size(); ++t) {
    if (random() % 5 != 0) continue;
    std::swap(spoilt.triangles[t][1], spoilt.triangles[t][2]);
    std::swap(spoilt.corner_normals[t][1], spoilt.corner_normals[t][2]);
    for (Vector3d& n : spoilt.corner_normals[t]) n = -n;
  }
  for (const double z : {3.0, 15.0, 20.1, 33.0}) {
    const auto expected = Slicer(body).cut(z);
    const auto got = Slicer(spoilt).cut(z);
    ASSERT_EQ(got.size(), 1U);
    ASSERT_TRUE(is_closed(got[0]));
    EXPECT_NEAR(area_of(got[0]), area_of(expected[0]), 1e-9);
    for (const Segment& s : got[0]) {
      const Vector2d outward = s.a_mm.normalized();
      const double theta = std::acos(1 - z / 20);
      EXPECT_LT((s.pull_a + std::tan(theta / 2) * outward).norm(), 0.05 * std::tan(theta / 2));
    }
  }
}

TEST(Slicer, OpenSurfacesAreClosedByStraightLines) {
  const Body body = testing::body_of(half_pipe(10, 12, 60));
  for (const double z : {0.5, 6.0, 11.9}) {
    const auto contours = Slicer(body).cut(z);
    ASSERT_EQ(contours.size(), 1U);
    ASSERT_TRUE(is_closed(contours[0]));
    EXPECT_NEAR(area_of(contours[0]), 50 * std::numbers::pi, 0.2);
    for (const Segment& s : contours[0]) EXPECT_GT(s.a_mm.x(), -1e-9);
  }
}

TEST(Slicer, AnOpenBowlIsSolidAtEachLevel) {
  // A hemisphere without thickness, mouth up: half of an icosphere's faces.
  mesh::Model model = sample::icosphere(20, 4);
  std::erase_if(model.triangles, [&](const Eigen::Vector3i& t) {
    return model.vertices[t[0]].z() > 1e-9 || model.vertices[t[1]].z() > 1e-9 ||
           model.vertices[t[2]].z() > 1e-9;
  });
  const Body body = testing::body_of(model);
  const double z = 12;
  const auto section = unite(Slicer(body).cut(z));
  ASSERT_EQ(section.size(), 1U);
  EXPECT_FALSE(section[0].is_hole);
  EXPECT_NEAR(area_of(section), std::numbers::pi * (400 - 64), 8);
}

TEST(Slicer, AMissingFaceIsBridged) {
  mesh::Model model = sample::icosphere(20, 4);
  const Body whole = testing::body_of(model);
  std::mt19937 random(9);
  std::erase_if(model.triangles, [&](const Eigen::Vector3i&) { return random() % 25 == 0; });
  const Body holed = testing::body_of(model);
  for (const double z : {5.0, 17.0, 30.0}) {
    const auto section = unite(Slicer(holed).cut(z));
    ASSERT_FALSE(section.empty());
    EXPECT_NEAR(area_of(section), area_of(unite(Slicer(whole).cut(z))), 5) << z;
    for (const Contour& contour : Slicer(holed).cut(z)) EXPECT_TRUE(is_closed(contour));
  }
}

TEST(Slicer, AcceptsABodyWithoutHeight) {
  mesh::Model model;
  model.path = "sheet";
  model.vertices = {{0, 0, 0}, {5, 0, 0}, {0, 5, 0}};
  model.triangles = {{0, 1, 2}};
  const Body body = testing::body_of(model);
  EXPECT_EQ(body.height_mm, 0);
  EXPECT_TRUE(Slicer(body).cut(0.002).empty());
}

TEST(Unite, OverlappingBoxesGiveOneContour) {
  const Body body = testing::body_of(testing::together(
      {testing::box({0, 0, 0}, {10, 10, 5}), testing::box({6, 4, 0}, {16, 14, 5})}));
  const auto section = unite(Slicer(body).cut(2.5));
  ASSERT_EQ(section.size(), 1U);
  EXPECT_FALSE(section[0].is_hole);
  EXPECT_NEAR(area_of(section), 200 - 4 * 6, 1e-4);
}

TEST(Unite, ABoxWithinABoxVanishes) {
  const Body body = testing::body_of(testing::together(
      {testing::box({0, 0, 0}, {10, 10, 5}), testing::box({3, 3, 1}, {7, 7, 4})}));
  const auto section = unite(Slicer(body).cut(2.5));
  ASSERT_EQ(section.size(), 1U);
  EXPECT_NEAR(area_of(section), 100, 1e-4);
}

TEST(Unite, ACavityIsAHole) {
  const Body body = testing::body_of(
      testing::together({testing::box({0, 0, 0}, {10, 10, 5}),
                         testing::inside_out(testing::box({3, 3, 1}, {7, 7, 4}))}));
  const auto section = unite(Slicer(body).cut(2.5));
  ASSERT_EQ(section.size(), 2U);
  EXPECT_FALSE(section[0].is_hole);
  EXPECT_TRUE(section[1].is_hole);
  EXPECT_EQ(section[1].parent, 0);
  EXPECT_NEAR(area_of(section), 100 - 16, 1e-4);
  EXPECT_TRUE(is_inside(section, {1, 1}));
  EXPECT_FALSE(is_inside(section, {5, 5}));
  EXPECT_FALSE(is_inside(section, {11, 5}));
}

TEST(Unite, NestsIslandsInHoles) {
  const auto square = [](double half, bool counter_clockwise) {
    std::vector<Vector2d> corners = {{-half, -half}, {half, -half}, {half, half}, {-half, half}};
    if (!counter_clockwise) std::reverse(corners.begin(), corners.end());
    Contour contour;
    for (std::size_t i = 0; i < 4; ++i) {
      contour.push_back({corners[i], corners[(i + 1) % 4], {0, 0}, {0, 0}});
    }
    return contour;
  };
  const auto section =
      unite({square(10, true), square(8, false), square(5, true), square(2, false)});
  ASSERT_EQ(section.size(), 4U);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(section[i].parent, i - 1);
    EXPECT_EQ(section[i].is_hole, i % 2 == 1);
    EXPECT_EQ(signed_area(section[i].points_mm) > 0, i % 2 == 0);
  }
  EXPECT_NEAR(area_of(section), 400 - 256 + 100 - 16, 1e-3);
}

TEST(CommonArea, OfTwoSquaresIsTheirOverlap) {
  const std::vector<Vector2d> a = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  const std::vector<Vector2d> b = {{3, 2}, {9, 2}, {9, 9}, {3, 9}};
  const std::vector<Vector2d> hole = {{3.5, 2.5}, {4, 2.5}, {4, 3}, {3.5, 3}};
  EXPECT_NEAR(common_area({a}, {b}), 2, 1e-5);
  EXPECT_NEAR(common_area({a}, {b, hole}), 1.75, 1e-5);
  EXPECT_EQ(common_area({a}, {}), 0);
}

}  // namespace
}  // namespace hydroprint::waterline
