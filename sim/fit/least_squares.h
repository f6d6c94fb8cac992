#pragma once

#include <Eigen/Core>
#include <functional>

#include "sim/base/result.h"

namespace hydroprint::fit {

/// The residuals of some points, two of each (x, y), mm, as a function of scaled parameters; NaN
/// for a point that has none.
using Residuals = std::function<Result<Eigen::VectorXd>(const Eigen::VectorXd& u)>;

/// Where parameters may lie, and by how much they are moved to take derivatives; all scaled.
struct Domain {
  Eigen::VectorXd low, high, step;
};

/// Residuals and their derivatives; rows of points without are NaN.
struct Linearised {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;

  /// The same without those rows.
  [[nodiscard]] Linearised of_known() const;
};

/// Mean square of the values that are known, mm2; infinite if there are none.
[[nodiscard]] double mean_square(const Eigen::VectorXd& residuals);

/// Derivatives by central differences; on one side alone at a bound.
[[nodiscard]] Result<Eigen::MatrixXd> differentiate(const Residuals& residuals,
                                                    const Eigen::VectorXd& u, const Domain& domain,
                                                    const Eigen::VectorXd& at_u);

/// The step that makes the linearised sum of squares least while parameters stay in the domain.
/// @param damping  relative to each parameter's own curvature (Marquardt); 0: none
/// @param most     no parameter moves by more
[[nodiscard]] Eigen::VectorXd bounded_step(const Linearised& known, const Eigen::VectorXd& u,
                                           const Domain& domain, double damping, double most);

struct Minimum {
  Eigen::VectorXd u;
  Linearised at;       ///< there
  int iterations = 0;  ///< Jacobians taken
  bool settled = false;
};

/// Least squares by damped Gauss-Newton steps from `u`. Ends when a step would move the parameters
/// by less than a twentieth of what their uncertainty comes to, given residuals that are no smaller
/// than `floor_mm`.
[[nodiscard]] Result<Minimum> minimise(const Residuals& residuals, Eigen::VectorXd u,
                                       const Domain& domain, double floor_mm);

}  // namespace hydroprint::fit
