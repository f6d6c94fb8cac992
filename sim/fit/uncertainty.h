#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/fit/least_squares.h"

namespace hydroprint::fit {

/// Covariance of least-squares estimates, scaled, by leaving out one point at a time (the jackknife
/// in its linearised form, known as HC3): honest for points whose errors differ, as they do where
/// film is stretched more or less, and for the two coordinates of a point, whose errors go
/// together. Directions in which the points hardly move (by less than the computation's own error
/// over all that is plausible) have a huge variance.
/// @param known     all rows known, two a point
/// @param floor_mm  error of every residual that does not show in the residuals: the computation's
[[nodiscard]] Eigen::MatrixXd jackknife_covariance(const Linearised& known, double floor_mm);

/// The linear map from residuals to minus the step of least squares: step = -gain * residuals.
/// Directions that the residuals do not depend on are left alone.
[[nodiscard]] Eigen::MatrixXd gain(const Eigen::MatrixXd& jacobian);

/// Quantile of Student's t.
/// @param probability  in (0, 1)
/// @param degrees      of freedom, above 0
[[nodiscard]] double student_t(double probability, double degrees);

/// Why a parameter is not known.
struct Unknown {
  Eigen::Index parameter = 0;
  double moves_mm = 0;    ///< by which it moves the points, rms, over all that is plausible
  double half_width = 0;  ///< of its interval, scaled
  /// The parameter that it is taken for, -1 if it is the points that say too little of it alone.
  Eigen::Index taken_for = -1;
};

/// The parameters (scaled) that the points cannot tell, to be held one after the other: those whose
/// interval would be wider than all that is plausible. First those that are unknown even where all
/// others are known; else, of those that are only unknown together, the one known least.
/// @param t  quantile that makes an interval of a standard error
[[nodiscard]] std::vector<Unknown> unknowns(const Linearised& known, double floor_mm, double t);

}  // namespace hydroprint::fit
