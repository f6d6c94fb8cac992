#include "sim/sheet/sheet_step.h"

#include <fmt/format.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "sim/base/check.h"
#include "sim/velocity/quadratic_elements.h"

namespace hydroprint::velocity {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;
using Matrix = Eigen::SparseMatrix<double>;
// The numbering of the unknowns already has low fill (FilmMesh::elimination_order).
using Factor = Eigen::SimplicialLLT<Matrix, Eigen::Lower, Eigen::NaturalOrdering<int>>;

constexpr double kTonnePerMm3 = 1e-12;  ///< 1 kg/m^3 in t/mm^3
constexpr int kMostIterations = 50;
constexpr int kMostHalvings = 30;
/// Largest change in the last full Newton step, relative to the largest velocity. The remaining
/// relative error is about its square.
constexpr double kTolerance = 1e-7;
/// Least decrease in the line search, relative to the slope.
constexpr double kLeastDecrease = 1e-4;

/// Second-order expansion of the objective in the velocities of the free nodes.
struct Quadratic {
  double value = 0;
  VectorXd gradient;
  Matrix hessian;  ///< lower triangle
};

class Step {
 public:
  Step(const FilmMesh& mesh, const std::vector<double>& thickness_mm, const StepFilm& film,
       double step_s, const std::vector<Vector2d>& before, const std::vector<Vector2d>& fixed)
      : mesh_(mesh),
        thickness_mm_(thickness_mm),
        film_(film),
        step_s_(step_s),
        before_(before),
        fixed_(fixed),
        unknowns_(mesh, fixed) {}

  [[nodiscard]] Result<std::vector<Vector2d>> solve();

 private:
  enum class Strain { kGreen, kLinear };
  using Velocities = std::vector<Vector2d>;

  [[nodiscard]] ElementVector gather(const Velocities& velocities, std::size_t triangle) const;
  [[nodiscard]] MembraneEnergy element(std::size_t triangle, const Velocities& velocities,
                                       Strain strain, Hessian kind) const;
  [[nodiscard]] double value(const Velocities& velocities) const;
  [[nodiscard]] bool turns_inside_out(const Velocities& velocities) const;
  [[nodiscard]] Quadratic expand(const Velocities& velocities, Strain strain, Hessian kind) const;
  [[nodiscard]] Result<VectorXd> direction(const Velocities& velocities, Strain strain,
                                           double& value, double& slope);
  [[nodiscard]] Velocities moved(const Velocities& from, const VectorXd& along, double by) const;
  [[nodiscard]] double largest(const Velocities& velocities) const;

  const FilmMesh& mesh_;
  const std::vector<double>& thickness_mm_;
  const StepFilm& film_;
  double step_s_;
  const Velocities& before_;
  const Velocities& fixed_;
  Unknowns unknowns_;
  Factor factor_;
  bool is_analysed_ = false;
};

ElementVector Step::gather(const Velocities& velocities, std::size_t triangle) const {
  ElementVector out;
  const auto node = nodes_of(mesh_, triangle);
  for (int i = 0; i < 6; ++i) out.segment<2>(2 * i) = velocities[node[i]];
  return out;
}

/// Computes one triangle's part of the objective as a function of its velocities: the integral of
/// rho h |u - u_before|^2 / 2 + dt k |u|^2 / 2 + W(dt u). Its gradient is dt times the balance of
/// forces.
MembraneEnergy Step::element(std::size_t triangle, const Velocities& velocities, Strain strain,
                             Hessian kind) const {
  const ElementVector u = gather(velocities, triangle);
  const bool is_linear = strain == Strain::kLinear;
  MembraneEnergy out = membrane_energy(
      mesh_, triangle, thickness_mm_[triangle], film_.elasticity,
      is_linear ? ElementVector(ElementVector::Zero()) : ElementVector(step_s_ * u), kind);
  out.hessian *= step_s_ * step_s_;
  out.gradient *= step_s_;
  if (is_linear) {
    out.gradient = out.hessian * u;
    out.energy_mj = 0.5 * u.dot(out.gradient);
  }
  const double area_mm2 = 0.5 * twice_area_mm2(mesh_, triangle);
  const auto add = [&](double coefficient, const ElementVector& w) {
    if (coefficient == 0) return;
    const ElementVector load = coefficient * area_mm2 * (unit_mass() * w);
    out.energy_mj += 0.5 * w.dot(load);
    out.gradient += load;
    out.hessian += coefficient * area_mm2 * unit_mass();
  };
  if (film_.density_kg_per_m3 > 0) {
    add(film_.density_kg_per_m3 * kTonnePerMm3 * thickness_mm_[triangle],
        u - gather(before_, triangle));
  }
  add(step_s_ * film_.drag_mpa_s_per_mm, u);
  return out;
}

double Step::value(const Velocities& velocities) const {
  double sum = 0;
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    sum += element(t, velocities, Strain::kGreen, Hessian::kNone).energy_mj;
  }
  return sum;
}

bool Step::turns_inside_out(const Velocities& velocities) const {
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    const MembraneEnergy e = element(t, velocities, Strain::kGreen, Hessian::kNone);
    if (!(e.least_area_ratio > 0)) return true;
  }
  return false;
}

Quadratic Step::expand(const Velocities& velocities, Strain strain, Hessian kind) const {
  const int size = 2 * unknowns_.count;
  Quadratic out{0, VectorXd::Zero(size), Matrix(size, size)};
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(78 * mesh_.triangles.size());
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    const MembraneEnergy e = element(t, velocities, strain, kind);
    out.value += e.energy_mj;
    const auto node = nodes_of(mesh_, t);
    for (int i = 0; i < 12; ++i) {
      const int free = unknowns_.of_node[node[i / 2]];
      if (free < 0) continue;
      const int row = 2 * free + i % 2;
      out.gradient[row] += e.gradient[i];
      for (int j = 0; j < 12; ++j) {
        const int column = 2 * unknowns_.of_node[node[j / 2]] + j % 2;
        if (column >= 0 && column <= row) entries.emplace_back(row, column, e.hessian(i, j));
      }
    }
  }
  out.hessian.setFromTriplets(entries.begin(), entries.end());
  return out;
}

/// Computes Newton's direction, which is a descent direction.
/// @param value  set to the objective at `velocities`
/// @param slope  set to the objective's derivative along the direction
Result<VectorXd> Step::direction(const Velocities& velocities, Strain strain, double& value,
                                 double& slope) {
  for (const Hessian kind : {Hessian::kTrue, Hessian::kPositive}) {
    const Quadratic local = expand(velocities, strain, kind);
    if (!is_analysed_) factor_.analyzePattern(local.hessian);
    is_analysed_ = true;
    factor_.factorize(local.hessian);
    if (factor_.info() != Eigen::Success) continue;
    VectorXd along = -factor_.solve(local.gradient);
    value = local.value;
    slope = along.dot(local.gradient);
    return along;
  }
  return fail(Code::kInternal,
              "velocity: the film mesh gives a singular matrix for a step. "
              "Please report this");
}

Step::Velocities Step::moved(const Velocities& from, const VectorXd& along, double by) const {
  Velocities out = from;
  for (std::size_t n = 0; n < out.size(); ++n) {
    const int free = unknowns_.of_node[n];
    if (free >= 0) out[n] += by * along.segment<2>(2 * free);
  }
  return out;
}

double Step::largest(const Velocities& velocities) const {
  double most = 0;
  for (const Vector2d& u : velocities) most = std::max(most, u.lpNorm<Eigen::Infinity>());
  return most;
}

Result<std::vector<Vector2d>> Step::solve() {
  Velocities velocities = fixed_;
  for (std::size_t n = 0; n < fixed_.size(); ++n) {
    if (unknowns_.of_node[n] >= 0) velocities[n].setZero();
  }
  if (unknowns_.count == 0) return velocities;
  double value_here = 0, slope = 0;
  HP_ASSIGN_OR_RETURN(VectorXd along, direction(velocities, Strain::kLinear, value_here, slope));
  velocities = moved(velocities, along, 1);
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    HP_ASSIGN_OR_RETURN(along, direction(velocities, Strain::kGreen, value_here, slope));
    if (!along.allFinite() || !std::isfinite(value_here)) break;
    if (along.lpNorm<Eigen::Infinity>() <= kTolerance * largest(velocities)) {
      velocities = moved(velocities, along, 1);
      if (turns_inside_out(velocities)) break;
      return velocities;
    }
    double by = 1;
    Velocities next = moved(velocities, along, by);
    for (int h = 0; h < kMostHalvings && !(value(next) <= value_here + kLeastDecrease * by * slope);
         ++h) {
      by *= 0.5;
      next = moved(velocities, along, by);
    }
    velocities = std::move(next);
  }
  return fail(Code::kInternal, fmt::format("velocity: a step of {:.3g} s of the viscous sheet with "
                                           "inertia does not converge. Compute without inertia",
                                           step_s_));
}

}  // namespace

Result<std::vector<Vector2d>> sheet_step(const FilmMesh& mesh,
                                         const std::vector<double>& thickness_mm,
                                         const StepFilm& film, double step_s,
                                         const std::vector<Vector2d>& before_mm_per_s,
                                         const std::vector<Vector2d>& fixed_mm_per_s) {
  HP_CHECK(step_s > 0);
  HP_CHECK(thickness_mm.size() == mesh.triangles.size());
  HP_CHECK(film.density_kg_per_m3 == 0 || before_mm_per_s.size() == mesh.node_count());
  HP_CHECK(fixed_mm_per_s.size() == mesh.node_count());
  return Step(mesh, thickness_mm, film, step_s, before_mm_per_s, fixed_mm_per_s).solve();
}

}  // namespace hydroprint::velocity
