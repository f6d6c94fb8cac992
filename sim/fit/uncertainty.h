#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/fit/least_squares.h"

namespace hydroprint::fit {

/// Scaled covariance of least-squares estimates, by leaving out one point at a time (the linearised
/// jackknife, known as HC3). It is valid for points with different errors, as where the film is
/// stretched more or less, and for a point's two coordinates, whose errors are correlated.
/// Directions in which the points hardly move (by less than the computation's own error over the
/// plausible range) have a huge variance.
/// @param known     all rows known, two per point
/// @param floor_mm  the computation's error in every residual, which the residuals do not show
[[nodiscard]] Eigen::MatrixXd jackknife_covariance(const Linearised& known, double floor_mm);

/// The linear map from residuals to the least-squares step: step = -gain * residuals. Directions on
/// which the residuals do not depend stay unchanged.
[[nodiscard]] Eigen::MatrixXd gain(const Eigen::MatrixXd& jacobian);

/// Quantile of Student's t.
/// @param probability  in (0, 1)
/// @param degrees      of freedom, above 0
[[nodiscard]] double student_t(double probability, double degrees);

/// Why a parameter is unknown.
struct Unknown {
  Eigen::Index parameter = 0;
  double moves_mm = 0;    ///< rms move of the points over its plausible range
  double half_width = 0;  ///< of its interval, scaled
  /// The parameter it is confused with; -1 if the points simply contain too little information on
  /// it.
  Eigen::Index taken_for = -1;
};

/// The parameters (scaled) that the points do not determine, to be held one after the other: those
/// with an interval wider than the plausible range. First come those that are unknown even if all
/// others are known. If there are none, the least known of those that are only unknown together.
/// @param t  quantile that turns a standard error into an interval
[[nodiscard]] std::vector<Unknown> unknowns(const Linearised& known, double floor_mm, double t);

}  // namespace hydroprint::fit
