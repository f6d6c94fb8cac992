#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "sim/velocity/velocity.h"
#include "tests/sim/velocity/lines.h"

namespace hydroprint::velocity {
namespace {

using Eigen::Vector2d;
using testing::Function;
using testing::irregular_mesh;
using testing::outline_of;
using testing::prescribed;

/// Largest error at any node if only the velocities on the film's edges are given.
double error_at_nodes(const FilmMesh& mesh, const Function& f) {
  const auto velocity = solve_stokes(mesh, prescribed(mesh, f));
  if (!velocity) return std::numeric_limits<double>::infinity();
  double most = 0;
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    most = std::max(most, ((*velocity)[n] - f(place_of(mesh, n))).norm());
  }
  return most;
}

TEST(Stokes, ReproducesLinearFields) {
  const FilmMesh mesh = irregular_mesh();
  EXPECT_LT(error_at_nodes(mesh,
                           [](const Vector2d& p) {
                             return Vector2d(0.3 + 0.02 * p.x() - 0.05 * p.y(),
                                             -1 + 0.01 * p.x() + 0.03 * p.y());
                           }),
            1e-10);
}

TEST(Stokes, ReproducesQuadraticHarmonicFields) {
  const FilmMesh mesh = irregular_mesh();
  EXPECT_LT(error_at_nodes(mesh,
                           [](const Vector2d& p) {
                             return Vector2d(1e-2 * (p.x() * p.x() - p.y() * p.y()),
                                             1e-2 * p.x() * p.y());
                           }),
            1e-9);
}

TEST(Stokes, KeepsConstantsConstantAndZeroZero) {
  const FilmMesh mesh = irregular_mesh();
  EXPECT_LT(error_at_nodes(mesh, [](const Vector2d&) { return Vector2d(2, -3); }), 1e-12);
  EXPECT_EQ(error_at_nodes(mesh, [](const Vector2d&) { return Vector2d(0, 0); }), 0);
}

/// Root mean square of the error over the film, for meshes scaled by `scale`.
double rms_error(double scale, const Function& f) {
  MeshOptions options;
  options.size.at_waterline_mm = 4 * scale;
  options.size.growth = 0.4 * scale;
  options.size.most_mm = 16 * scale;
  options.spacing_mm = 4 * scale;
  options.tolerance_mm = 1;
  options.least_mm = 0.1;
  const FilmMesh mesh = mesh_film(outline_of("160x120"),
                                  testing::line_round({testing::circle({0, 0}, 20, 2000)}), options)
                            .value();
  const auto velocity = solve_stokes(mesh, prescribed(mesh, f));
  const VelocityField field(mesh, velocity.value());
  double square = 0, area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3i& v = mesh.triangles[t];
    for (int i = 0; i < 3; ++i) {
      for (const double weight : {0.8, 0.45, 0.1}) {
        Vector2d p = weight * mesh.vertices_mm[v[i]];
        for (const int j : {(i + 1) % 3, (i + 2) % 3}) {
          p += 0.5 * (1 - weight) * mesh.vertices_mm[v[j]];
        }
        Vector2d u;
        if (!field.at(p, 1e-6, u)) return std::numeric_limits<double>::infinity();
        square += testing::area_of(mesh, t) * (u - f(p)).squaredNorm();
      }
    }
    area += 9 * testing::area_of(mesh, t);
  }
  return std::sqrt(square / area);
}

void expect_third_order(const Function& f) {
  const double coarse = rms_error(2, f), middle = rms_error(1, f), fine = rms_error(0.5, f);
  EXPECT_GT(std::log2(coarse / middle), 2.5) << coarse << ' ' << middle << ' ' << fine;
  EXPECT_GT(std::log2(middle / fine), 2.5) << coarse << ' ' << middle << ' ' << fine;
  EXPECT_LT(fine, 1e-4);
}

TEST(Stokes, ConvergesWithTheThirdPowerOfTheMeshSizeToALogarithm) {
  expect_third_order([](const Vector2d& p) {
    return Vector2d(std::log(p.norm() / 20), std::log((p - Vector2d(5, 3)).norm()));
  });
}

TEST(Stokes, ConvergesWithTheThirdPowerOfTheMeshSizeToADipole) {
  expect_third_order([](const Vector2d& p) { return Vector2d(20 * p / p.squaredNorm()); });
}

TEST(Stokes, ObeysTheMaximumPrinciple) {
  const FilmMesh mesh = irregular_mesh();
  const auto line = testing::line_round(
      {testing::bean({-12, 5}, 15), {{15, -20}, {30, -22}, {33, -5}, {20, -12}}});
  const auto fixed = boundary_velocities(mesh, line.pulls);
  const auto velocity = solve_stokes(mesh, fixed).value();
  Vector2d low = Vector2d::Zero(), high = Vector2d::Zero();
  for (const Vector2d& u : fixed) {
    if (std::isnan(u.x())) continue;
    low = low.cwiseMin(u);
    high = high.cwiseMax(u);
  }
  for (const Vector2d& u : velocity) {
    EXPECT_TRUE(((u - low).array() > -5e-3).all() && ((high - u).array() > -5e-3).all());
    EXPECT_LT(u.norm(), 1.005);
  }
}

TEST(Stokes, OfACylinderIsTheRadialSolution) {
  // For unit pull at r = a, the solution is u_r = -(c / (1 - c^2)) (Rv / r - r / Rv) with c = a /
  // Rv.
  const double a = 20, vat = 60, c = a / vat;
  const FilmMesh mesh = mesh_film(outline_of("circle:60"),
                                  testing::line_round({testing::circle({0, 0}, a, 1500)}), {})
                            .value();
  const auto line = testing::line_round({testing::circle({0, 0}, a, 1500)});
  const auto velocity = solve_stokes(mesh, boundary_velocities(mesh, line.pulls)).value();
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    const Vector2d p = place_of(mesh, n);
    const double r = p.norm();
    const Vector2d expected = -c / (1 - c * c) * (vat / r - r / vat) * p / r;
    EXPECT_LT((velocity[n] - expected).norm(), 1e-3) << r;
  }
}

TEST(BoundaryVelocities, AreThePullAtTheWaterlineAndZeroAtTheVat) {
  const auto solid = testing::circle({4, 3}, 15, 800);
  const auto line = testing::line_round({solid});
  const FilmMesh mesh = mesh_film(outline_of("100x80"), line, {}).value();
  const auto fixed = boundary_velocities(mesh, line.pulls);
  const std::size_t vertices = mesh.vertices_mm.size();
  std::vector<char> at_edge(mesh.node_count(), 0);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (mesh.edge_kind[e] == EdgeKind::kInner) continue;
    for (const std::size_t n : {vertices + e, static_cast<std::size_t>(mesh.edges[e][0]),
                                static_cast<std::size_t>(mesh.edges[e][1])}) {
      at_edge[n] = 1;
      const Vector2d p = place_of(mesh, n);
      const Vector2d expected = mesh.edge_kind[e] == EdgeKind::kVat
                                    ? Vector2d(0, 0)
                                    : Vector2d((Vector2d(4, 3) - p).normalized());
      EXPECT_LT((fixed[n] - expected).norm(), 2e-3);
    }
  }
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    EXPECT_EQ(std::isnan(fixed[n].x()), at_edge[n] == 0);
  }
}

TEST(BoundaryVelocities, AtACornerAreTheMeanOfBothSides) {
  const testing::Curve square = {{-10, -10}, {10, -10}, {10, 10}, {-10, 10}};
  auto line = testing::line_round({square});
  waterline::Contour contour;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector2d along = (square[(i + 1) % 4] - square[i]).normalized();
    const Vector2d inwards(-along.y(), along.x());
    contour.push_back({square[i], square[(i + 1) % 4], inwards, inwards});
  }
  line.pulls = waterline::PullIndex({contour});
  const FilmMesh mesh = mesh_film(outline_of("100x80"), line, {}).value();
  const auto fixed = boundary_velocities(mesh, line.pulls);
  int corners = 0;
  for (std::size_t v = 0; v < mesh.vertices_mm.size(); ++v) {
    const Vector2d& p = mesh.vertices_mm[v];
    if ((p.cwiseAbs() - Vector2d(10, 10)).norm() > 1e-9) continue;
    EXPECT_LT((fixed[v] + p / 20).norm(), 1e-9) << p.transpose();
    ++corners;
  }
  EXPECT_EQ(corners, 4);
}

TEST(BoundaryVelocities, AreNotLargerWhereTwoSolidsTouch) {
  const waterline::Waterline line = testing::line_round(
      {{{-20, -20}, {0, -20}, {0, 0}, {-20, 0}}, {{0, 0}, {20, 0}, {20, 20}, {0, 20}}});
  const FilmMesh mesh = mesh_film(outline_of("100x80"), line, {}).value();
  const Vector2d unit(-0.6, -0.8);
  const waterline::PullIndex pulls({{{{-30, -30}, {30, 30}, unit, unit}}});
  for (const Vector2d& u : boundary_velocities(mesh, pulls)) {
    if (!std::isnan(u.x())) {
      EXPECT_LT(u.norm(), 1 + 1e-9);
    }
  }
}

}  // namespace
}  // namespace hydroprint::velocity
