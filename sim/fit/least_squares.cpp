#include "sim/fit/least_squares.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "sim/base/check.h"

namespace hydroprint::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMostIterations = 12;
constexpr int kMostTrials = 5;
constexpr double kFirstDamping = 1e-3;
constexpr double kSettledShare = 0.05;  ///< largest last step, as a fraction of the uncertainty
constexpr double kMostStep = 1;

/// Returns the mean squares of `a` and `b` over the rows in which neither is NaN.
std::pair<double, double> mean_squares(const VectorXd& a, const VectorXd& b) {
  double sum_a = 0, sum_b = 0;
  Index count = 0;
  for (Index i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i]) || std::isnan(b[i])) continue;
    sum_a += a[i] * a[i];
    sum_b += b[i] * b[i];
    ++count;
  }
  const double none = std::numeric_limits<double>::infinity();
  if (count == 0) return {none, none};
  return {sum_a / static_cast<double>(count), sum_b / static_cast<double>(count)};
}

/// Minimises |r + J d|^2 + damping over the free parameters; the other parameters
/// change as given in `d`.
void solve_free(const Linearised& known, double damping, const std::vector<Index>& free,
                VectorXd& d) {
  HP_CHECK(damping >= 0);
  HP_CHECK(d.size() == known.jacobian.cols());
  const auto count = static_cast<Index>(free.size());
  MatrixXd jacobian(known.jacobian.rows(), count);
  for (Index k = 0; k < count; ++k) {
    jacobian.col(k) = known.jacobian.col(free[k]);
    d[free[k]] = 0;
  }
  const VectorXd rest = known.residuals + known.jacobian * d;
  MatrixXd normal = jacobian.transpose() * jacobian;
  normal.diagonal() *= 1 + damping;
  const VectorXd solved =
      normal.completeOrthogonalDecomposition().solve(-jacobian.transpose() * rest);
  for (Index k = 0; k < count; ++k) d[free[k]] = solved[k];
}

}  // namespace

Linearised Linearised::of_known() const {
  std::vector<Index> rows;
  for (Index i = 0; i < residuals.size(); ++i) {
    if (std::isfinite(residuals[i]) && jacobian.row(i).allFinite()) rows.push_back(i);
  }
  return {residuals(rows), jacobian(rows, Eigen::all)};
}

double mean_square(const VectorXd& residuals) { return mean_squares(residuals, residuals).first; }

Result<MatrixXd> differentiate(const Residuals& residuals, const VectorXd& u, const Domain& domain,
                               const VectorXd& at_u) {
  MatrixXd jacobian(at_u.size(), u.size());
  for (Index j = 0; j < u.size(); ++j) {
    VectorXd below = u, above = u;
    VectorXd at_below = at_u, at_above = at_u;
    if (u[j] - domain.step[j] >= domain.low[j]) {
      below[j] -= domain.step[j];
      HP_ASSIGN_OR_RETURN(at_below, residuals(below));
    }
    if (u[j] + domain.step[j] <= domain.high[j]) {
      above[j] += domain.step[j];
      HP_ASSIGN_OR_RETURN(at_above, residuals(above));
    }
    jacobian.col(j) = (at_above - at_below) / (above[j] - below[j]);
  }
  return jacobian;
}

VectorXd bounded_step(const Linearised& known, const VectorXd& u, const Domain& domain,
                      double damping, double most) {
  const VectorXd low = (domain.low - u).cwiseMax(-most);
  const VectorXd high = (domain.high - u).cwiseMin(most);
  std::vector<Index> free(static_cast<std::size_t>(u.size()));
  for (Index j = 0; j < u.size(); ++j) free[j] = j;
  VectorXd d = VectorXd::Zero(u.size());
  while (!free.empty()) {
    solve_free(known, damping, free, d);
    const auto is_within = [&](Index j) { return d[j] >= low[j] && d[j] <= high[j]; };
    const auto beyond = std::stable_partition(free.begin(), free.end(), is_within);
    if (beyond == free.end()) break;
    for (auto j = beyond; j != free.end(); ++j) d[*j] = std::clamp(d[*j], low[*j], high[*j]);
    free.erase(beyond, free.end());
  }
  return d;
}

Result<Minimum> minimise(const Residuals& residuals, VectorXd u, const Domain& domain,
                         double floor_mm) {
  Minimum out{std::move(u), {}, 0, false};
  HP_ASSIGN_OR_RETURN(out.at.residuals, residuals(out.u));
  double damping = kFirstDamping;
  while (out.iterations < kMostIterations) {
    ++out.iterations;
    HP_ASSIGN_OR_RETURN(out.at.jacobian, differentiate(residuals, out.u, domain, out.at.residuals));
    const Linearised known = out.at.of_known();
    const auto few = static_cast<double>(out.u.size());
    const double variance = mean_square(known.residuals) + floor_mm * floor_mm;
    const VectorXd wanted =
        bounded_step(known, out.u, domain, std::min(damping, kFirstDamping), kMostStep);
    const double share = (known.jacobian * wanted).squaredNorm() / (few * variance);
    if (!(share > kSettledShare * kSettledShare)) {
      out.settled = true;
      return out;
    }
    bool moved = false;
    for (int trial = 0; trial < kMostTrials && !moved; ++trial) {
      const VectorXd step = bounded_step(known, out.u, domain, damping, kMostStep);
      const VectorXd next = out.u + step;
      HP_ASSIGN_OR_RETURN(VectorXd at_next, residuals(next));
      const auto [before, after] = mean_squares(out.at.residuals, at_next);
      moved = after < before;
      damping *= moved ? 0.1 : 30;
      if (!moved) continue;
      out.u = next;
      out.at.residuals = std::move(at_next);
    }
    if (!moved) break;  // only numerical noise is left
  }
  return out;
}

}  // namespace hydroprint::fit
