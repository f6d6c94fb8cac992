#include "sim/sheet/sheet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "sim/velocity/quadratic_elements.h"
#include "tests/sim/velocity/lines.h"

namespace hydroprint::velocity {
namespace {

using Eigen::Vector2d;
using testing::Function;
using testing::irregular_mesh;
using testing::prescribed;

double error_of(const FilmMesh& mesh, const std::vector<double>& thickness, const Function& f) {
  Sheet sheet(mesh, 0, prescribed(mesh, f));
  const auto nodes = sheet.solve(thickness).value();
  double most = 0;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    most = std::max(most, (nodes[n] - f(place_of(mesh, n))).norm());
  }
  return most;
}

TEST(Sheet, ReproducesLinearFields) {
  const FilmMesh mesh = irregular_mesh();
  EXPECT_LT(error_of(mesh, std::vector<double>(mesh.triangles.size(), 0.3),
                     [](const Vector2d& p) {
                       return Vector2d(0.3 + 0.02 * p.x() - 0.05 * p.y(),
                                       -1 + 0.01 * p.x() + 0.03 * p.y());
                     }),
            1e-10);
}

TEST(Sheet, RotatesAsAWholeForAnyThickness) {
  const FilmMesh mesh = irregular_mesh();
  std::vector<double> thickness;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    thickness.push_back(0.1 + 0.01 * static_cast<double>(t % 40));
  EXPECT_LT(error_of(mesh, thickness,
                     [](const Vector2d& p) { return Vector2d(1 - 0.2 * p.y(), 2 + 0.2 * p.x()); }),
            1e-9);
}

// In a uniform film, the force is div(2 (D + tr(D) I)) = Laplace(u) + 3 grad(div u), which is zero
// for these quadratics.
TEST(Sheet, ReproducesItsQuadraticSolutions) {
  const FilmMesh mesh = irregular_mesh();
  const std::vector<double> thickness(mesh.triangles.size(), 1);
  EXPECT_LT(error_of(mesh, thickness,
                     [](const Vector2d& p) {
                       return Vector2d(1e-2 * (p.x() * p.x() - 4 * p.y() * p.y()), 0);
                     }),
            1e-9);
  EXPECT_LT(error_of(mesh, thickness,
                     [](const Vector2d& p) {
                       return Vector2d(1e-2 * p.x() * p.y(), -1.5e-2 * p.x() * p.x());
                     }),
            1e-9);
}

// A strip that is drawn along x. Its boundary has the velocities of the exact solution
// 4 h u' = const.
TEST(Sheet, IsStretchedWhereItIsThin) {
  const FilmMesh mesh =
      mesh_film(film::parse_outline("80x20").value(), testing::line_round({}), {}).value();
  const auto thickness_at = [](double x) { return 1 + 0.5 * std::tanh(x / 10); };
  // u is the integral of dx / h, computed by Simpson's rule.
  const auto drawn = [&](double x) {
    const int n = 200;
    const double step = (x + 40) / n;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const double at = -40 + i * step;
      sum += step / 6 *
             (1 / thickness_at(at) + 4 / thickness_at(at + step / 2) + 1 / thickness_at(at + step));
    }
    return sum;
  };
  std::vector<double> thickness;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const double x =
        (mesh.vertices_mm[t[0]] + mesh.vertices_mm[t[1]] + mesh.vertices_mm[t[2]]).x() / 3;
    thickness.push_back(thickness_at(x));
  }
  // With u_y = 0, N_yy = 2 h u' does not vary along y, so the film is in balance.
  EXPECT_LT(error_of(mesh, thickness, [&](const Vector2d& p) { return Vector2d(drawn(p.x()), 0); }),
            0.02 * drawn(40));
}

TEST(Sheet, SecondSolutionDoesNotRememberTheFirst) {
  const FilmMesh mesh = irregular_mesh();
  const auto fixed = prescribed(mesh, [](const Vector2d& p) {
    return p.norm() < 40 ? Vector2d(-p / p.norm()) : Vector2d(0, 0);
  });
  const auto thickness_of = [&](double slope) {
    std::vector<double> thickness;
    for (const Eigen::Vector3i& t : mesh.triangles) {
      thickness.push_back(1 + slope * std::tanh(mesh.vertices_mm[t[0]].x() / 15));
    }
    return thickness;
  };
  Sheet twice(mesh, 1e-3, fixed), once(mesh, 1e-3, fixed);
  (void)twice.solve(thickness_of(0.3)).value();
  const auto second = twice.solve(thickness_of(0.7)).value();
  const auto alone = once.solve(thickness_of(0.7)).value();
  for (std::size_t n = 0; n < alone.size(); ++n) EXPECT_LT((second[n] - alone[n]).norm(), 1e-6);
}

}  // namespace
}  // namespace hydroprint::velocity
