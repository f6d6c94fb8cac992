#include "sim/velocity/locator.h"

#include <gtest/gtest.h>

#include <random>

#include "sim/velocity/velocity.h"
#include "tests/sim/velocity/lines.h"

namespace hydroprint::velocity {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

FilmMesh mesh_of(const std::string& film) {
  MeshOptions options;
  options.size.at_waterline_mm = 3;
  options.spacing_mm = 3;
  options.tolerance_mm = 0.2;
  return mesh_film(
             film::parse_outline(film).value(),
             testing::line_round({testing::bean({-8, 4}, 12), testing::circle({20, 9}, 5, 90)}),
             options)
      .value();
}

double cross(const Vector2d& u, const Vector2d& v) { return u.x() * v.y() - u.y() * v.x(); }

/// Distance from a point to one triangle; 0 inside.
double distance_to(const FilmMesh& mesh, const Eigen::Vector3i& t, const Vector2d& p) {
  std::vector<Vector2d> corners;
  for (const int v : t) corners.push_back(mesh.vertices_mm[v]);
  bool inside = true;
  for (std::size_t i = 0; i < 3; ++i) {
    inside = inside && cross(corners[(i + 1) % 3] - corners[i], p - corners[i]) >= 0;
  }
  return inside ? 0 : testing::distance_to(corners, p);
}

Vector2d point_at(const FilmMesh& mesh, const Locator::Place& place) {
  const Eigen::Vector3i& t = mesh.triangles[place.triangle];
  return place.barycentric[0] * mesh.vertices_mm[t[0]] +
         place.barycentric[1] * mesh.vertices_mm[t[1]] +
         place.barycentric[2] * mesh.vertices_mm[t[2]];
}

TEST(Locator, FindsWhatBruteForceFinds) {
  for (const std::string film : {"70x60", "circle:40"}) {
    const FilmMesh mesh = mesh_of(film);
    const Locator locator(mesh);
    std::mt19937 random(21);
    std::uniform_real_distribution<double> place(-45, 45);
    int inside = 0, near = 0, off = 0;
    for (int i = 0; i < 6000; ++i) {
      const Vector2d p(place(random), place(random));
      double nearest = 1e300;
      for (const auto& t : mesh.triangles) nearest = std::min(nearest, distance_to(mesh, t, p));
      const Locator::Place found = locator.find(p);
      if (nearest > Locator::kReach_mm + 1e-9) {
        EXPECT_EQ(found.triangle, -1) << p.transpose();
        ++off;
        continue;
      }
      ASSERT_GE(found.triangle, 0) << p.transpose();
      EXPECT_NEAR(found.outside_mm, nearest, 1e-9);
      EXPECT_NEAR((point_at(mesh, found) - p).norm(), nearest, 1e-9);
      EXPECT_GE(found.barycentric.minCoeff(), -1e-9);
      EXPECT_NEAR(found.barycentric.sum(), 1, 1e-12);
      ++(nearest > 0 ? near : inside);
    }
    EXPECT_GT(inside, 500);
    EXPECT_GT(near, 50);
    EXPECT_GT(off, 100);
  }
}

TEST(Locator, FindsEveryVertexAndEdgeMiddle) {
  const FilmMesh mesh = mesh_of("70x60");
  const Locator locator(mesh);
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    const Locator::Place found = locator.find(place_of(mesh, n));
    ASSERT_GE(found.triangle, 0);
    EXPECT_LT(found.outside_mm, 1e-9);
  }
}

TEST(Locator, FindsNothingInAnEmptyMeshOrForNan) {
  EXPECT_EQ(Locator().find({0, 0}).triangle, -1);
  EXPECT_EQ(Locator(FilmMesh()).find({0, 0}).triangle, -1);
  const Locator locator(mesh_of("70x60"));
  EXPECT_EQ(locator.find({std::nan(""), 0}).triangle, -1);
  EXPECT_EQ(locator.find({1e300, -1e300}).triangle, -1);
}

TEST(VelocityField, InterpolatesQuadraticsExactly) {
  const FilmMesh mesh = mesh_of("70x60");
  const auto f = [](const Vector2d& p) {
    return Vector2d(1 + 2 * p.x() - p.y() + 0.1 * p.x() * p.y(),
                    0.3 * p.x() * p.x() - 0.2 * p.y() * p.y() + p.y());
  };
  std::vector<Vector2d> nodes;
  for (std::size_t n = 0; n < mesh.node_count(); ++n) nodes.push_back(f(place_of(mesh, n)));
  const VelocityField field(mesh, nodes);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-36, 36);
  int tested = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector2d p(place(random), place(random));
    Vector2d u(7, 7);
    if (field.at(p, 0, u)) {
      EXPECT_LT((u - f(p)).norm(), 1e-9);
      ++tested;
    } else {
      EXPECT_EQ(u, Vector2d(7, 7)) << "the result must not change where there is no film";
    }
  }
  EXPECT_GT(tested, 1000);
}

TEST(VelocityField, ReachesOutsideTheFilmUpToTheGivenDistance) {
  const FilmMesh mesh = mesh_of("70x60");
  std::vector<Vector2d> nodes;
  for (std::size_t n = 0; n < mesh.node_count(); ++n) nodes.push_back(place_of(mesh, n));
  const VelocityField field(mesh, nodes);
  Vector2d u;
  ASSERT_TRUE(field.at({35.3, 10}, 0.4, u));
  EXPECT_LT((u - Vector2d(35, 10)).norm(), 1e-9);
  EXPECT_FALSE(field.at({35.3, 10}, 0.2, u));
}

}  // namespace
}  // namespace hydroprint::velocity
