#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/film/profile.h"
#include "sim/fit/least_squares.h"
#include "sim/fit/parameters.h"
#include "sim/fit/uncertainty.h"

namespace hydroprint::fit {

/// Share of intervals that contain the true value.
inline constexpr double kConfidence = 0.95;

/// A fitted parameter in the profile's terms: mm, or a ratio for swelling. A drag length is
/// infinite where there is no drag.
struct Estimate {
  Parameter parameter = Parameter::kInkRatio;
  std::string name;
  double start = 0, value = 0;
  double standard_error = 0;        ///< NaN for a drag length at its bound
  double low = 0, high = 0;         ///< of the interval
  bool is_one_sided = false;        ///< the estimate and one end lie at a bound
  double scaled = 0;                ///< the fitted value, see parameters.h
  double scaled_error = 0;          ///< its standard error
  double discretisation_error = 0;  ///< the part due to the computation itself, scaled
};

/// A parameter that was not fitted and keeps its value.
struct Undetermined {
  std::string name;
  std::string reason;  ///< a clause for people
};

/// The estimates with their intervals.
/// @param at              residuals and derivatives at u, all known
/// @param floor_mm        as in jackknife_covariance()
/// @param discretisation  standard error of each due to the computation itself, scaled
[[nodiscard]] std::vector<Estimate> estimates_of(const std::vector<Parameter>& free,
                                                 const film::Profile& start,
                                                 const Eigen::VectorXd& u, const Domain& domain,
                                                 const Linearised& at, double floor_mm,
                                                 const Eigen::VectorXd& discretisation);

/// The correlation matrix of a covariance matrix.
[[nodiscard]] Eigen::MatrixXd correlation_of(const Eigen::MatrixXd& covariance);

/// Degrees of freedom that remain after fitting the parameters; at least 1.
[[nodiscard]] int degrees_of_freedom(const Linearised& known);

/// Explains for people why a parameter is held.
[[nodiscard]] Undetermined explain(const Unknown& unknown, const std::vector<Parameter>& free,
                                   const film::Profile& start, double residual_mm);

/// The parameters that landing points never determine.
[[nodiscard]] std::vector<Undetermined> never_determined();

}  // namespace hydroprint::fit
