#include "sim/sheet/sheet_step.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include "sim/sheet/sheet.h"
#include "sim/velocity/quadratic_elements.h"
#include "sim/velocity/velocity.h"
#include "tests/sim/velocity/lines.h"

namespace hydroprint::velocity {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Velocities = std::vector<Vector2d>;
using testing::Function;
using testing::irregular_mesh;
using testing::prescribed;

/// Viscosity that corresponds to Young's modulus and the time step in the paper.
constexpr double kViscosity_mpa_s = 1.82 * 0.02 / 3;
constexpr double kDensity_kg_per_m3 = 1300;
constexpr double kDipSpeed_mm_per_s = 5;
const Vector2d kUnknown = Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());

/// A round body off the middle of a rectangular film, with a band of thicker film next to it.
struct Scene {
  waterline::Waterline line;
  FilmMesh mesh;
  std::vector<double> thickness_mm;
  Velocities fixed;  ///< velocities of the film's boundary, in mm/s
  Velocities quasistatic;
};

Scene scene() {
  Scene out;
  out.line = testing::line_round({testing::circle({-12, 5}, 18, 800)});
  MeshOptions options;
  options.size.at_waterline_mm *= 2;
  options.spacing_mm *= 2;
  out.mesh = mesh_film(film::parse_outline("100x80").value(), out.line, options).value();
  for (const auto& t : out.mesh.triangles) {
    const double x =
        (out.mesh.vertices_mm[t[0]] + out.mesh.vertices_mm[t[1]] + out.mesh.vertices_mm[t[2]]).x() /
        3;
    out.thickness_mm.push_back(x > 10 && x < 25 ? 0.7 : 0.5);
  }
  out.fixed = boundary_velocities(out.mesh, out.line.pulls);
  // The pull at theta = 100 degrees is tan(50 degrees) = 1.2.
  for (Vector2d& u : out.fixed) u *= 1.2 * kDipSpeed_mm_per_s;
  out.quasistatic = Sheet(out.mesh, 0, out.fixed).solve(out.thickness_mm).value();
  return out;
}

/// A film that has this viscosity with steps of this length.
StepFilm film_of(double viscosity_mpa_s, double step_s, double density_kg_per_m3) {
  return {{3 * viscosity_mpa_s / step_s, 0.5}, density_kg_per_m3};
}

Velocities scaled(Velocities u, double by) {
  for (Vector2d& v : u) v *= by;
  return u;
}

double largest(const Velocities& u) {
  double most = 0;
  for (const Vector2d& v : u) most = std::max(most, v.norm());
  return most;
}

double difference(const Velocities& a, const Velocities& b) {
  double most = 0;
  for (std::size_t n = 0; n < a.size(); ++n) most = std::max(most, (a[n] - b[n]).norm());
  return most;
}

/// Relative growth of the velocities, as in a dip of some seconds.
constexpr double kGrowth_per_s = 0.2;

/// Velocities after a step of a film without mass.
Velocities light_step(const Scene& s, double step_s) {
  return sheet_step(s.mesh, s.thickness_mm, film_of(kViscosity_mpa_s, step_s, 0), step_s, {},
                    s.fixed)
      .value();
}

/// Velocities after a step in which the film's boundary accelerates by the share kGrowth_per_s of
/// its present velocity. Before the step, the film moves as if it had no mass.
Velocities heavy_step(const Scene& s, double step_s, double density_kg_per_m3) {
  return sheet_step(s.mesh, s.thickness_mm, film_of(kViscosity_mpa_s, step_s, density_kg_per_m3),
                    step_s, scaled(light_step(s, step_s), 1 - kGrowth_per_s * step_s), s.fixed)
      .value();
}

TEST(SheetStep, ConvergesToTheQuasistaticSheetLinearlyAtFixedViscosity) {
  const Scene s = scene();
  double coarse = difference(light_step(s, 0.08), s.quasistatic);
  for (const double step_s : {0.04, 0.02, 0.01, 0.005}) {
    const double fine = difference(light_step(s, step_s), s.quasistatic);
    EXPECT_NEAR(std::log2(coarse / fine), 1, 0.05) << step_s;
    coarse = fine;
  }
  EXPECT_LT(coarse, 2e-3 * largest(s.quasistatic));
  EXPECT_GT(coarse, 1e-6 * largest(s.quasistatic));
}

TEST(SheetStep, DiffersFromTheQuasistaticSheetByAFloorDueToInertia) {
  // The effect of the nonlinear strain vanishes with the step. The effect of the film's
  // acceleration remains, and is real: the velocity lags by its rate of change times the response
  // time of the mass. This lag does not depend on the step and is proportional to the density.
  const Scene s = scene();
  const auto lag_mm_per_s = [&](double step_s, double density_kg_per_m3) {
    return difference(heavy_step(s, step_s, density_kg_per_m3), light_step(s, step_s));
  };
  const double lag = lag_mm_per_s(1e-3, kDensity_kg_per_m3);
  EXPECT_NEAR(lag_mm_per_s(1e-3, 2 * kDensity_kg_per_m3) / lag, 2, 0.05);
  EXPECT_NEAR(lag_mm_per_s(1e-2, kDensity_kg_per_m3) / lag, 1, 0.05);
  // The response time is rho L^2 / (mu pi^2), with L about the width of the film.
  const double decay_s =
      kDensity_kg_per_m3 * 1e-12 * 50 * 50 / (kViscosity_mpa_s * std::pow(std::numbers::pi, 2));
  const double estimate = decay_s * kGrowth_per_s * largest(s.quasistatic);
  EXPECT_LT(lag, estimate);
  EXPECT_GT(lag, 0.01 * estimate);
  // With the paper's step, the error is far above the lag; with steps of microseconds, it equals
  // the lag.
  EXPECT_GT(difference(heavy_step(s, 0.02, kDensity_kg_per_m3), s.quasistatic), 100 * lag);
  // With steps shorter than the response time, the lag needs many steps to develop.
  const double step_s = 2e-6;
  const StepFilm film = film_of(kViscosity_mpa_s, step_s, kDensity_kg_per_m3);
  Velocities u = scaled(s.quasistatic, 1 - kGrowth_per_s * 75 * step_s);
  for (int step = 74; step >= 0; --step) {
    u = sheet_step(s.mesh, s.thickness_mm, film, step_s, u,
                   scaled(s.fixed, 1 - kGrowth_per_s * step * step_s))
            .value();
  }
  EXPECT_NEAR(difference(u, light_step(s, step_s)) / lag, 1, 0.05);
  EXPECT_NEAR(difference(u, s.quasistatic) / lag, 1, 0.3);
}

TEST(SheetStep, ForgetsItsInitialVelocityWithinMilliseconds) {
  const Scene s = scene();
  const double step_s = 1e-4;
  const StepFilm film = film_of(kViscosity_mpa_s, step_s, kDensity_kg_per_m3);
  Velocities from_rest(s.mesh.node_count(), Vector2d::Zero());
  Velocities in_motion = s.quasistatic;
  double apart = largest(s.quasistatic);
  for (int step = 0; step < 10; ++step) {
    from_rest = sheet_step(s.mesh, s.thickness_mm, film, step_s, from_rest, s.fixed).value();
    in_motion = sheet_step(s.mesh, s.thickness_mm, film, step_s, in_motion, s.fixed).value();
    const double now = difference(from_rest, in_motion);
    EXPECT_LT(now, 0.5 * apart) << step;
    EXPECT_GT(now, 0.01 * apart) << step;
    apart = now;
  }
}

TEST(SheetStep, DependsOnlyOnTheRatioOfDensityToYoungsModulus) {
  const Scene s = scene();
  const Velocities rest(s.mesh.node_count(), Vector2d::Zero());
  const auto step = [&](double y_mpa, double density, double nu) {
    return sheet_step(s.mesh, s.thickness_mm, {{y_mpa, nu}, density}, 0.02, rest, s.fixed).value();
  };
  const double speed = largest(s.quasistatic);
  const Velocities paper = step(1.82, 1300, 0.5);
  EXPECT_LT(difference(paper, step(18.2, 13000, 0.5)), 1e-9 * speed);
  // Without mass, Young's modulus has no effect; with mass, a softer film lags more.
  const Velocities light = step(1.82, 0, 0.5);
  EXPECT_LT(difference(light, step(0.001, 0, 0.5)), 1e-9 * speed);
  const double lag = difference(paper, light), soft_lag = difference(step(0.91, 1300, 0.5), light);
  EXPECT_GT(lag, 1e-5 * speed);
  EXPECT_NEAR(soft_lag / lag, 2, 0.1);
  EXPECT_NEAR(difference(step(1.82, 2600, 0.5), light) / lag, 2, 0.1);
  // Poisson's ratio has an effect: film that changes its volume moves differently.
  EXPECT_GT(difference(light, step(1.82, 0, 0.3)), 1e-3 * speed);
}

TEST(SheetStep, HasTheSameWaterDragAsTheQuasistaticSheet) {
  const Scene s = scene();
  const double drag_per_mm = 0.5 / (30 * 30);  // drag length 30 mm
  const Velocities quasistatic = Sheet(s.mesh, drag_per_mm, s.fixed).solve(s.thickness_mm).value();
  StepFilm film = film_of(kViscosity_mpa_s, 1e-5, 0);
  film.drag_mpa_s_per_mm = kViscosity_mpa_s * drag_per_mm;
  const auto u = sheet_step(s.mesh, s.thickness_mm, film, 1e-5, quasistatic, s.fixed).value();
  EXPECT_LT(difference(u, quasistatic), 1e-4 * largest(quasistatic));
  EXPECT_GT(difference(u, s.quasistatic), 1e-2 * largest(quasistatic));
}

// --- energy and forces

ElementVector drawn(std::mt19937& random, double most) {
  std::uniform_real_distribution<double> uniform(-most, most);
  ElementVector out;
  for (double& x : out) x = uniform(random);
  return out;
}

constexpr Elasticity kElasticity = {1.82, 0.4};

TEST(MembraneEnergy, ForcesAndHessianAreItsDerivatives) {
  const FilmMesh mesh = irregular_mesh();
  std::mt19937 random(7);
  for (std::size_t t = 0; t < 40; ++t) {
    const double size = std::sqrt(twice_area_mm2(mesh, t));
    const ElementVector d = drawn(random, 0.2 * size);
    const auto at = [&](const ElementVector& x) {
      return membrane_energy(mesh, t, 0.5, kElasticity, x);
    };
    const MembraneEnergy here = at(d);
    const double step = 1e-5 * size;
    for (int i = 0; i < 12; ++i) {
      const ElementVector by = step * ElementVector::Unit(i);
      const MembraneEnergy more = at(d + by), less = at(d - by);
      EXPECT_NEAR((more.energy_mj - less.energy_mj) / (2 * step), here.gradient[i],
                  1e-7 * here.gradient.norm());
      EXPECT_LT(((more.gradient - less.gradient) / (2 * step) - here.hessian.col(i)).norm(),
                1e-7 * here.hessian.norm());
    }
  }
}

TEST(MembraneEnergy, OfALinearDisplacementIsEquationFour) {
  const FilmMesh mesh = irregular_mesh();
  Matrix2d F;
  F << 1.2, 0.1, -0.3, 0.8;
  const Matrix2d e = 0.5 * (F.transpose() * F - Matrix2d::Identity());
  const double nu = kElasticity.poisson_ratio;
  const double density_mpa = kElasticity.young_modulus_mpa * 0.5 / (2 * (1 - nu * nu)) *
                             ((1 - nu) * (e * e).trace() + nu * e.trace() * e.trace());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    ElementVector d;
    const auto node = nodes_of(mesh, t);
    for (int i = 0; i < 6; ++i) {
      d.segment<2>(2 * i) = (F - Matrix2d::Identity()) * place_of(mesh, node[i]);
    }
    EXPECT_NEAR(membrane_energy(mesh, t, 0.5, kElasticity, d).energy_mj,
                density_mpa * testing::area_of(mesh, t), 1e-10 * testing::area_of(mesh, t));
  }
}

TEST(MembraneEnergy, IsInvariantUnderRotationOfAnySize) {
  const FilmMesh mesh = irregular_mesh();
  std::mt19937 random(3);
  const ElementVector d = drawn(random, 0.1);
  const auto node = nodes_of(mesh, 0);
  const double unturned_mj = membrane_energy(mesh, 0, 0.5, kElasticity, d).energy_mj;
  for (const double angle : {0.1, 1.0, 3.0}) {
    const Matrix2d turn = Eigen::Rotation2Dd(angle).toRotationMatrix();
    ElementVector turned;
    for (int i = 0; i < 6; ++i) {
      const Vector2d p = place_of(mesh, node[i]);
      turned.segment<2>(2 * i) = turn * (p + d.segment<2>(2 * i)) + Vector2d(4, -7) - p;
    }
    EXPECT_NEAR(membrane_energy(mesh, 0, 0.5, kElasticity, turned).energy_mj, unturned_mj,
                1e-10 * unturned_mj);
  }
}

TEST(MembraneEnergy, HasAPositiveHessianAsFallback) {
  const FilmMesh mesh = irregular_mesh();
  ElementVector pressed;  // displacements that compress the element to half its size
  const auto node = nodes_of(mesh, 0);
  for (int i = 0; i < 6; ++i) pressed.segment<2>(2 * i) = -0.5 * place_of(mesh, node[i]);
  const auto least = [&](Hessian kind) {
    const ElementMatrix h = membrane_energy(mesh, 0, 0.5, kElasticity, pressed, kind).hessian;
    return Eigen::SelfAdjointEigenSolver<ElementMatrix>(h).eigenvalues()[0] / h.norm();
  };
  EXPECT_LT(least(Hessian::kTrue), -1e-2);
  EXPECT_GT(least(Hessian::kPositive), -1e-12);
}

// --- whole films

Velocities everywhere(const FilmMesh& mesh, const Function& f) {
  Velocities out;
  for (std::size_t n = 0; n < mesh.node_count(); ++n) out.push_back(f(place_of(mesh, n)));
  return out;
}

/// The velocities that deform the film by the gradient F within one step.
Function to(const Matrix2d& F, double step_s) {
  return [=](const Vector2d& p) { return Vector2d((F - Matrix2d::Identity()) * p / step_s); };
}

TEST(SheetStep, PassesThePatchTestForStrainsOfAnySize) {
  const FilmMesh mesh = irregular_mesh();
  const std::vector<double> thickness_mm(mesh.triangles.size(), 0.5);
  Matrix2d large, pressed;
  large << 1.6, 0.2, -0.3, 0.9;
  pressed << 0.9, 0.05, 0.02, 0.75;
  for (const Matrix2d& F : {large, pressed}) {
    const Function f = to(F, 0.02);
    const auto u = sheet_step(mesh, thickness_mm, {{1.82, 0.5}, 0}, 0.02, {}, prescribed(mesh, f));
    ASSERT_TRUE(u) << u.error().message;
    EXPECT_LT(difference(*u, everywhere(mesh, f)), 1e-7 * largest(*u));
  }
}

TEST(SheetStep, RotatesTheFilmAsAWholeForAnyThickness) {
  const FilmMesh mesh = irregular_mesh();
  std::vector<double> thickness_mm;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    thickness_mm.push_back(0.3 + 0.1 * static_cast<double>(t % 5));
  }
  const Function f = to(Eigen::Rotation2Dd(0.4).toRotationMatrix(), 0.02);
  const Velocities exact = everywhere(mesh, f);
  const auto u =
      sheet_step(mesh, thickness_mm, {{1.82, 0.5}, 1300}, 0.02, exact, prescribed(mesh, f));
  ASSERT_TRUE(u) << u.error().message;
  EXPECT_LT(difference(*u, exact), 1e-7 * largest(*u));
}

TEST(SheetStep, ConservesTheMomentumOfAFreeFilm) {
  const Scene s = scene();
  const StepFilm film = {{1.82, 0.5}, kDensity_kg_per_m3};
  const double step_s = 1e-3;  // long enough for the film to push, too short for it to come to rest
  const Velocities before = everywhere(s.mesh, [](const Vector2d& p) {
    return Vector2d(30 * std::sin(p.x() / 20) - p.y(), 20 * std::cos(p.y() / 15) + 0.5 * p.x());
  });
  const Velocities nothing_held(s.mesh.node_count(), kUnknown);
  const auto after = sheet_step(s.mesh, s.thickness_mm, film, step_s, before, nothing_held).value();
  // Sums linear momentum, and angular momentum around the origin with the film's position after the
  // step.
  Vector2d linear_before(0, 0), linear_after(0, 0);
  double angular_before = 0, angular_after = 0, energy_before = 0, energy_after = 0;
  for (std::size_t t = 0; t < s.mesh.triangles.size(); ++t) {
    const auto node = nodes_of(s.mesh, t);
    for (const QuadraturePoint& point : quadrature()) {
      const auto n = shape_values(point.barycentric);
      Vector2d place(0, 0), u(0, 0), v(0, 0);
      for (int i = 0; i < 6; ++i) {
        place += n[i] * (place_of(s.mesh, node[i]) + step_s * after[node[i]]);
        u += n[i] * before[node[i]];
        v += n[i] * after[node[i]];
      }
      const double mass = point.weight * testing::area_of(s.mesh, t) * s.thickness_mm[t];
      linear_before += mass * u;
      linear_after += mass * v;
      angular_before += mass * (place.x() * u.y() - place.y() * u.x());
      angular_after += mass * (place.x() * v.y() - place.y() * v.x());
      energy_before += mass * u.squaredNorm();
      energy_after += mass * v.squaredNorm();
    }
  }
  EXPECT_LT((linear_after - linear_before).norm(), 1e-9 * linear_before.norm());
  EXPECT_NEAR(angular_after, angular_before, 1e-9 * std::abs(angular_before));
  EXPECT_LT(energy_after, 0.95 * energy_before);
  EXPECT_GT(difference(after, before), 0.1 * largest(before));
}

TEST(SheetStep, ConvergesForVeryLongStepsOrReportsAnError) {
  const Scene s = scene();
  const Velocities rest(s.mesh.node_count(), Vector2d::Zero());
  const auto step = [&](double step_s) {
    return sheet_step(s.mesh, s.thickness_mm, {{1.82, 0.5}, 1300}, step_s, rest, s.fixed);
  };
  for (const double step_s : {1e-6, 0.02, 0.5, 1.0}) {
    EXPECT_TRUE(step(step_s)) << step_s;
  }
  const auto u = step(100);  // this step would push the film through itself
  ASSERT_FALSE(u);
  EXPECT_EQ(u.error().code, Code::kInternal);
  EXPECT_NE(u.error().message.find("does not converge"), std::string::npos) << u.error().message;
}

}  // namespace
}  // namespace hydroprint::velocity
