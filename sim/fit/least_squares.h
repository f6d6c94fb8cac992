#pragma once

#include <Eigen/Core>
#include <functional>

#include "sim/base/result.h"

namespace hydroprint::fit {

/// The residuals of the points, two per point (x, y), mm, as a function of scaled parameters; NaN
/// for a point without a prediction.
using Residuals = std::function<Result<Eigen::VectorXd>(const Eigen::VectorXd& u)>;

/// Bounds of the parameters, and their steps for derivatives; all scaled.
struct Domain {
  Eigen::VectorXd low, high, step;
};

/// Residuals and their derivatives; NaN in the rows of points without a prediction.
struct Linearised {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;

  /// The same, without NaN rows.
  [[nodiscard]] Linearised of_known() const;
};

/// Mean square of the known values, mm2; infinite if there are none.
[[nodiscard]] double mean_square(const Eigen::VectorXd& residuals);

/// Derivatives by central differences; one-sided at a bound.
[[nodiscard]] Result<Eigen::MatrixXd> differentiate(const Residuals& residuals,
                                                    const Eigen::VectorXd& u, const Domain& domain,
                                                    const Eigen::VectorXd& at_u);

/// The step that minimises the linearised sum of squares within the domain.
/// @param damping  relative to each parameter's own curvature (Marquardt); 0: none
/// @param most     largest change of any parameter
[[nodiscard]] Eigen::VectorXd bounded_step(const Linearised& known, const Eigen::VectorXd& u,
                                           const Domain& domain, double damping, double most);

struct Minimum {
  Eigen::VectorXd u;
  Linearised at;       ///< at u
  int iterations = 0;  ///< Jacobians taken
  bool settled = false;
};

/// Least squares by damped Gauss-Newton steps from `u`. Ends when a step would move the parameters
/// by less than a twentieth of their uncertainty, with residuals of at least `floor_mm`.
[[nodiscard]] Result<Minimum> minimise(const Residuals& residuals, Eigen::VectorXd u,
                                       const Domain& domain, double floor_mm);

}  // namespace hydroprint::fit
