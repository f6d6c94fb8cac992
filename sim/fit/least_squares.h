#pragma once

#include <Eigen/Core>
#include <functional>

#include "sim/base/result.h"

namespace hydroprint::fit {

/// The residuals of the points in mm, two per point (x, y), as a function of the scaled parameters;
/// NaN for a point without a prediction.
using Residuals = std::function<Result<Eigen::VectorXd>(const Eigen::VectorXd& u)>;

/// Bounds of the parameters, and the step sizes for differentiation; all scaled.
struct Domain {
  Eigen::VectorXd low, high, step;
};

/// Residuals and their derivatives; NaN in the rows of points without a prediction.
struct Linearised {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;

  /// Returns the rows that do not contain NaN.
  [[nodiscard]] Linearised of_known() const;
};

/// Returns the mean square of the values that are not NaN, mm2; infinite if there are none.
[[nodiscard]] double mean_square(const Eigen::VectorXd& residuals);

/// Computes derivatives by central differences; one-sided at a bound.
[[nodiscard]] Result<Eigen::MatrixXd> differentiate(const Residuals& residuals,
                                                    const Eigen::VectorXd& u, const Domain& domain,
                                                    const Eigen::VectorXd& at_u);

/// Returns the step that minimises the linearised sum of squares within the domain.
/// @param damping  relative to each parameter's own curvature (Marquardt); 0: none
/// @param most     maximum change of any parameter
[[nodiscard]] Eigen::VectorXd bounded_step(const Linearised& known, const Eigen::VectorXd& u,
                                           const Domain& domain, double damping, double most);

struct Minimum {
  Eigen::VectorXd u;
  Linearised at;       ///< linearisation at u
  int iterations = 0;  ///< number of Jacobians computed
  bool settled = false;
};

/// Minimises the sum of squares by damped Gauss-Newton steps from `u`. Ends when a step would
/// change the parameters by less than a twentieth of their uncertainty, assuming residuals of at
/// least `floor_mm`.
[[nodiscard]] Result<Minimum> minimise(const Residuals& residuals, Eigen::VectorXd u,
                                       const Domain& domain, double floor_mm);

}  // namespace hydroprint::fit
