#include "sim/velocity/film_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>

#include "sim/sample/icosphere.h"
#include "sim/velocity/velocity.h"
#include "tests/sim/support/bodies.h"
#include "tests/sim/velocity/lines.h"

namespace hydroprint::velocity {
namespace {

using Eigen::Vector2d;
using testing::Curve;
using testing::outline_of;

FilmMesh meshed(const film::Outline& film, const waterline::Waterline& line,
                const MeshOptions& options = {}) {
  auto mesh = mesh_film(film, line, options);
  if (!mesh) {
    ADD_FAILURE() << mesh.error().message;
    return {};
  }
  return *mesh;
}

double total_area(const FilmMesh& mesh) {
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) area += testing::area_of(mesh, t);
  return area;
}

double least_angle_deg(const FilmMesh& mesh) {
  double least = 180;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const Vector2d u = mesh.vertices_mm[t[(i + 1) % 3]] - mesh.vertices_mm[t[i]];
      const Vector2d v = mesh.vertices_mm[t[(i + 2) % 3]] - mesh.vertices_mm[t[i]];
      const double angle = std::atan2(std::abs(u.x() * v.y() - u.y() * v.x()), u.dot(v));
      least = std::min(least, angle * 180 / std::numbers::pi);
    }
  }
  return least;
}

/// Checks the mesh of the film around separate solids: area, orientation, edges and velocities.
void expect_sound(const film::Outline& film, const std::vector<Curve>& solids,
                  double tolerance_mm = 0.016) {
  const waterline::Waterline line = testing::line_round(solids);
  const FilmMesh mesh = meshed(film, line);
  ASSERT_FALSE(mesh.triangles.empty());
  double expected = waterline::signed_area(film.polygon);
  double perimeter = 0;
  for (const Curve& solid : solids) {
    expected -= waterline::signed_area(solid);
    for (std::size_t i = 0; i < solid.size(); ++i) {
      perimeter += (solid[(i + 1) % solid.size()] - solid[i]).norm();
    }
  }
  EXPECT_NEAR(total_area(mesh), expected, tolerance_mm * perimeter + 1e-9);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    EXPECT_GT(testing::area_of(mesh, t), 0);
    for (int i = 0; i < 3; ++i) {
      const auto& edge = mesh.edges[mesh.triangle_edges[t][i]];
      const std::array<int, 2> corners = {mesh.triangles[t][(i + 1) % 3],
                                          mesh.triangles[t][(i + 2) % 3]};
      EXPECT_TRUE(edge == corners || (edge[0] == corners[1] && edge[1] == corners[0]));
    }
  }
  std::vector<int> sides(mesh.edges.size(), 0);
  for (const auto& edges : mesh.triangle_edges) {
    for (const int e : edges) ++sides[e];
  }
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const Vector2d middle = place_of(mesh, mesh.vertices_mm.size() + e);
    double to_line = 1e300;
    for (const Curve& solid : solids) {
      to_line = std::min(to_line, testing::distance_to(solid, middle));
    }
    switch (mesh.edge_kind[e]) {
      case EdgeKind::kInner:
        EXPECT_EQ(sides[e], 2);
        break;
      case EdgeKind::kVat:
        EXPECT_EQ(sides[e], 1);
        EXPECT_LT(testing::distance_to(film.polygon, middle), 1e-6);
        break;
      case EdgeKind::kWaterline:
        EXPECT_EQ(sides[e], 1);
        EXPECT_LT(to_line, tolerance_mm);
        break;
    }
  }
  const auto velocity = solve_stokes(mesh, boundary_velocities(mesh, line.pulls));
  ASSERT_TRUE(velocity);
  for (const Vector2d& u : *velocity) {
    EXPECT_TRUE(u.allFinite());
    EXPECT_LT(u.norm(), 1.02);
  }
}

TEST(FilmMesh, CoversTheFilmOutsideTheSolids) {
  expect_sound(outline_of("100x80"), {testing::bean({-10, 5}, 18)});
  expect_sound(outline_of("circle:60"), {testing::bean({15, -20}, 15)});
  expect_sound(outline_of("A4"),
               {testing::circle({-40, 0}, 25, 400), testing::circle({40, 10}, 30, 400)});
}

TEST(FilmMesh, WithoutAWaterlineCoversTheWholeFilm) {
  const FilmMesh mesh = meshed(outline_of("100x80"), testing::line_round({}));
  EXPECT_NEAR(total_area(mesh), 8000, 1e-6);
  for (const EdgeKind kind : mesh.edge_kind) EXPECT_NE(kind, EdgeKind::kWaterline);
}

TEST(FilmMesh, HasNoAngleBelow30DegreesAtSmoothWaterlines) {
  for (const std::string film : {"100x80", "circle:60"}) {
    const FilmMesh mesh =
        meshed(outline_of(film), testing::line_round({testing::bean({5, 0}, 20)}));
    EXPECT_GE(least_angle_deg(mesh), 30 - 1e-6) << film;
  }
}

TEST(FilmMesh, HasNoAngleBelow30DegreesAtTheWaterlinesOfASphere) {
  const film::Outline film = outline_of("A4");
  const waterline::Body body = hydroprint::testing::body_of(
      hydroprint::testing::moved(sample::icosphere(45, 5), {25, -40, 0}));
  const auto lines = waterline::take_waterlines(body, film, 88, {}, {}, {});
  ASSERT_TRUE(lines);
  for (std::size_t i = 0; i < lines->lines.size(); i += 9) {
    const FilmMesh mesh = meshed(film, lines->lines[i]);
    EXPECT_GE(least_angle_deg(mesh), 30 - 1e-6) << lines->lines[i].immersion_mm;
  }
}

TEST(FilmMesh, KeepsToTheSizingField) {
  const film::Outline film = outline_of("200x160");
  const Curve solid = testing::circle({0, 0}, 30, 400);
  const MeshOptions options;
  const FilmMesh mesh = meshed(film, testing::line_round({solid}), options);
  for (const auto& [a, b] : mesh.edges) {
    const Vector2d& p = mesh.vertices_mm[a];
    const Vector2d& q = mesh.vertices_mm[b];
    const double distance = std::abs((0.5 * (p + q)).norm() - 30);
    const double wanted = std::min(options.size.most_mm,
                                   options.size.at_waterline_mm + options.size.growth * distance);
    EXPECT_LT((p - q).norm(), 1.35 * wanted + 1);
  }
}

TEST(FilmMesh, ThinGapsBetweenSolidsSurvive) {
  for (const double gap : {1.0, 0.3, 0.1, 0.05}) {
    expect_sound(outline_of("120x90"), {testing::circle({-15 - gap / 2, 0}, 15, 400),
                                        testing::circle({15 + gap / 2, 0}, 15, 400)});
  }
}

TEST(FilmMesh, ThinParallelGapsSurvive) {
  // Two boards that face each other over a narrow slit of film.
  for (const double gap : {0.5, 0.1}) {
    const Curve left = {{-10, -20}, {-gap / 2, -20}, {-gap / 2, 20}, {-10, 20}};
    const Curve right = {{gap / 2, -20}, {10, -20}, {10, 20}, {gap / 2, 20}};
    expect_sound(outline_of("120x90"), {left, right});
  }
}

TEST(FilmMesh, AThinGapToTheFilmsEdgeSurvives) {
  for (const double gap : {1.0, 0.2, 0.05}) {
    expect_sound(outline_of("100x80"), {testing::circle({30 - gap, 3}, 20, 500)});
  }
}

TEST(FilmMesh, TinyContoursSurvive) {
  for (const double radius : {1.0, 0.3, 0.1, 0.03, 0.018}) {
    const film::Outline film = outline_of("100x80");
    const Curve solid = testing::circle({7, -11}, radius, 24);
    const waterline::Waterline line = testing::line_round({solid});
    const FilmMesh mesh = meshed(film, line);
    // Chords of 0.1 mm (MeshOptions::least_mm) may cut off much of the smallest solid, but not all.
    const double share = (8000 - total_area(mesh)) / waterline::signed_area(solid);
    EXPECT_GT(share, 0.5) << radius;
    EXPECT_LT(share, 1.0001) << radius;
    EXPECT_GE(std::count(mesh.edge_kind.begin(), mesh.edge_kind.end(), EdgeKind::kWaterline), 3);
  }
}

TEST(FilmMesh, ThinSolidsSurvive) {
  for (const double half : {0.5, 0.1, 0.03}) {
    // The ends of the thinnest solids are below MeshOptions::least_mm and become points.
    expect_sound(outline_of("100x80"), {{{-20, -half}, {20, -half}, {20, half}, {-20, half}}},
                 half > 0.05 ? 0.016 : half + 1e-9);
  }
}

TEST(FilmMesh, SolidsThatTouchAtACornerAreMeshed) {
  const film::Outline film = outline_of("100x80");
  const waterline::Waterline line = testing::line_round(
      {{{-20, -20}, {0, -20}, {0, 0}, {-20, 0}}, {{0, 0}, {20, 0}, {20, 20}, {0, 20}}});
  EXPECT_NEAR(total_area(meshed(film, line)), 8000 - 800, 1e-6);
}

TEST(FilmMesh, LeavesOutRegionsWithoutFilm) {
  // A ring with an island in its hole, with and without film in the hole.
  const film::Outline film = outline_of("100x80");
  waterline::Waterline line = testing::line_round({testing::circle({0, 0}, 30, 600)});
  Curve hole = testing::circle({0, 0}, 20, 600);
  std::reverse(hole.begin(), hole.end());
  line.section.push_back({hole, true, 0});
  line.section.push_back({testing::circle({0, 0}, 10, 400), false, 1});
  constexpr double kPi = std::numbers::pi;
  line.bounds_film = {1, 1, 1};
  EXPECT_NEAR(total_area(meshed(film, line)), 8000 - kPi * (900 - 400 + 100), 5);
  line.bounds_film = {1, 0, 0};
  EXPECT_NEAR(total_area(meshed(film, line)), 8000 - kPi * 900, 3);
}

/// A limit for small films, whose meshes of about a thousand vertices do not depend on how thin
/// walls and gaps are.
constexpr std::size_t kFewVertices = 8000;

TEST(FilmMesh, SolidsThinnerThanTheMeshAreMeshedCheaply) {
  for (const double thickness : {0.05, 0.01, 1e-3, 1e-4}) {
    const Curve fin = {{-20, -5}, {20, -4}, {20, thickness - 4}, {-20, thickness - 5}};
    const FilmMesh mesh = meshed(outline_of("100x80"), testing::line_round({fin}));
    EXPECT_NEAR(total_area(mesh), 8000, 40.1 * thickness) << thickness;
    EXPECT_LT(mesh.vertices_mm.size(), kFewVertices) << thickness;
  }
}

TEST(FilmMesh, WallsThinnerThanTheMeshAreMeshedCheaply) {
  // With a turn, chords of the two sides cross, because MeshOptions::tolerance_mm exceeds the wall.
  const film::Outline film = outline_of("100x80");
  for (const double wall : {0.05, 0.01, 1e-3}) {
    for (const double turn : {0.0, 0.02}) {
      waterline::Waterline line = testing::line_round({testing::circle({0, 0}, 30, 400)});
      Curve hole = testing::circle({0, 0}, 30 - wall, 400);
      for (Vector2d& p : hole) p = Eigen::Rotation2Dd(turn) * p;
      std::reverse(hole.begin(), hole.end());
      line.section.push_back({hole, true, 0});
      line.bounds_film.push_back(1);
      const FilmMesh mesh = meshed(film, line);
      EXPECT_NEAR(total_area(mesh), 8000, 190 * (wall + 0.02)) << wall;
      EXPECT_LT(mesh.vertices_mm.size(), kFewVertices) << wall << " " << turn;
      const auto velocity = solve_stokes(mesh, boundary_velocities(mesh, line.pulls));
      ASSERT_TRUE(velocity) << wall;
      for (const Vector2d& u : *velocity) EXPECT_LT(u.norm(), 1.02) << wall;
    }
  }
}

TEST(FilmMesh, NearlyTouchingCurvesAreMeshedCheaply) {
  const film::Outline film = outline_of("100x100");
  for (const double gap : {0.1, 0.01, 1e-3, 1e-5}) {
    const double x = 10 + gap;
    const waterline::Waterline line =
        testing::line_round({{{0, -5}, {10, -5}, {10, 5}, {0, 5}},
                             {{x, -4.3}, {x + 10, -4.3}, {x + 10, 5.7}, {x, 5.7}}});
    const FilmMesh mesh = meshed(film, line);
    EXPECT_NEAR(total_area(mesh), 9800, 0.02) << gap;
    EXPECT_LT(mesh.vertices_mm.size(), kFewVertices) << gap;
    const auto velocity = solve_stokes(mesh, boundary_velocities(mesh, line.pulls));
    ASSERT_TRUE(velocity) << gap;
    for (const Vector2d& u : *velocity) EXPECT_LT(u.norm(), 1.02) << gap;
  }
}

TEST(FilmMesh, CurvesThatTouchAtASmallAngleAreMeshedCheaply) {
  const film::Outline film = outline_of("100x100");
  const waterline::Waterline line = testing::line_round(
      {{{0, -5}, {20, -5}, {20, 0}, {0, 0}}, {{10, 0}, {25, 0.02}, {25, 5}, {10, 5}}});
  const FilmMesh mesh = meshed(film, line);
  EXPECT_NEAR(total_area(mesh), 10000 - 100 - 75, 0.3);
  EXPECT_LT(mesh.vertices_mm.size(), kFewVertices);
}

TEST(FilmMesh, MeshesFarLargerThanTheCoarsestSizeImpliesAreRefused) {
  MeshOptions options;
  options.size.at_waterline_mm = 0.2;
  options.size.growth = 0;
  const auto mesh = mesh_film(outline_of("100x100"), testing::line_round({}), options);
  ASSERT_FALSE(mesh) << mesh->vertices_mm.size();
  EXPECT_EQ(mesh.error().reason, ErrorReason::MESH_UNBOUNDED);
}

}  // namespace
}  // namespace hydroprint::velocity
