#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/film/profile.h"
#include "sim/fit/least_squares.h"
#include "sim/fit/parameters.h"
#include "sim/fit/uncertainty.h"

namespace hydroprint::fit {

/// Confidence level of the intervals.
inline constexpr double kConfidence = 0.95;

/// A fitted parameter in the units of the film profile: mm, or a ratio for swelling. The drag
/// length is infinite if there is no drag.
struct Estimate {
  Parameter parameter = Parameter::kInkRatio;
  std::string name;
  double start = 0, value = 0;
  double standard_error = 0;        ///< NaN for a drag length at its bound
  double low = 0, high = 0;         ///< ends of the confidence interval
  bool is_one_sided = false;        ///< the estimate and one end of the interval lie at a bound
  double scaled = 0;                ///< the fitted value, scaled (see parameters.h)
  double scaled_error = 0;          ///< its standard error
  double discretisation_error = 0;  ///< the part of scaled_error due to discretisation
};

/// A parameter that was not fitted and keeps its value.
struct Undetermined {
  std::string name;
  std::string reason;  ///< a clause that a message can end with
};

/// Computes the estimates and their confidence intervals.
/// @param at              residuals and derivatives at u, none of them NaN
/// @param floor_mm        as in jackknife_covariance()
/// @param discretisation  for each parameter, the standard error due to discretisation, scaled
[[nodiscard]] std::vector<Estimate> estimates_of(const std::vector<Parameter>& free,
                                                 const film::Profile& start,
                                                 const Eigen::VectorXd& u, const Domain& domain,
                                                 const Linearised& at, double floor_mm,
                                                 const Eigen::VectorXd& discretisation);

/// Returns the correlation matrix for a covariance matrix.
[[nodiscard]] Eigen::MatrixXd correlation_of(const Eigen::MatrixXd& covariance);

/// Returns the degrees of freedom that remain after fitting the parameters; at least 1.
[[nodiscard]] int degrees_of_freedom(const Linearised& known);

/// Explains in words why a parameter is held.
[[nodiscard]] Undetermined explain(const Unknown& unknown, const std::vector<Parameter>& free,
                                   const film::Profile& start, double residual_mm);

/// Returns the parameters that landing points can never determine.
[[nodiscard]] std::vector<Undetermined> never_determined();

}  // namespace hydroprint::fit
