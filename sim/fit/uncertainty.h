#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/fit/least_squares.h"

namespace hydroprint::fit {

/// Computes the scaled covariance of least-squares estimates by leaving out one point at a time
/// (the linearised jackknife, known as HC3). It is valid if errors differ between points, for
/// example because stretch varies, and if the errors of a point's two coordinates are correlated.
/// Directions in which the points hardly move (by less than the discretisation error over the
/// plausible range) have a huge variance.
/// @param known     only rows that are not NaN, two per point
/// @param floor_mm  the discretisation error in every residual, which the residuals do not show
[[nodiscard]] Eigen::MatrixXd jackknife_covariance(const Linearised& known, double floor_mm);

/// Returns the linear map from residuals to the least-squares step: step = -gain * residuals. The
/// step is zero in directions on which the residuals do not depend.
[[nodiscard]] Eigen::MatrixXd gain(const Eigen::MatrixXd& jacobian);

/// Returns a quantile of Student's t.
/// @param probability  in (0, 1)
/// @param degrees      of freedom, above 0
[[nodiscard]] double student_t(double probability, double degrees);

/// A parameter that the points do not determine, and the reason.
struct Unknown {
  Eigen::Index parameter = 0;
  double moves_mm = 0;    ///< rms displacement of the points over the parameter's plausible range
  double half_width = 0;  ///< half the width of its interval, scaled
  /// Index of the parameter with which it is confused; -1 if the points contain too little
  /// information on it.
  Eigen::Index taken_for = -1;
};

/// Returns the parameters to hold next, because their interval is wider than the plausible range.
/// These are the parameters that would be undetermined even if all others were known. If there are
/// no such parameters, only the least certain of those that are undetermined together is returned.
/// @param t  quantile that converts a standard error to an interval
[[nodiscard]] std::vector<Unknown> unknowns(const Linearised& known, double floor_mm, double t);

}  // namespace hydroprint::fit
