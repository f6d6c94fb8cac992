#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/pose.h"
#include "sim/base/result.h"
#include "sim/film/profile.h"
#include "sim/fit/estimates.h"
#include "sim/fit/parameters.h"
#include "sim/fit/points.h"
#include "sim/mesh/model.h"
#include "sim/pipeline/pipeline.h"

namespace hydroprint::fit {

struct Options {
  std::vector<Parameter> free = {kAllParameters.begin(), kAllParameters.end()};
  bool drop_outliers = false;
  std::string points_name = "points";  ///< of the points' file, for messages
};

/// What became of a measured point. Places on the film are printed ones, in F, mm.
struct PointResult {
  Point point;
  Eigen::Vector2d before_mm;  ///< what lands there by the profile to start from; NaN: nothing
  Eigen::Vector2d after_mm;   ///< by the fitted one
  std::string left_out;       ///< why it does not count; empty: it does
  bool is_outlier = false;    ///< its residual lies beyond 4 robust standard deviations

  [[nodiscard]] bool is_used() const { return left_out.empty(); }
};

struct Outcome {
  film::Profile profile;         ///< the starting one with what could be fitted
  Pose X_FO = Pose::Identity();  ///< as used: lowest point on the water, z = 0
  std::vector<Estimate> estimates;
  Eigen::MatrixXd correlation;  ///< of the estimates, in their order
  std::vector<Undetermined> undetermined;
  std::vector<PointResult> points;
  double rms_before_mm = 0, rms_after_mm = 0;  ///< of the used points' distances on the film
  double residual_sigma_mm = 0;                ///< standard deviation of one coordinate
  double discretisation_mm = 0;  ///< rms by which finer meshes and steps move the prediction
  int degrees_of_freedom = 0;
  double t_quantile = 0;  ///< Student's, of two-sided intervals
  int iterations = 0, dips = 0;
  bool settled = true;
  Warnings warnings;
};

/// The profile by which the sheet (section 4.3, quasistatic) brings the measured points' film to
/// where it was found: least squares of (predicted - measured) printed point, mm, with 95 %
/// intervals. What the points do not tell keeps its value in `dip.profile` and is listed.
/// Warns where the dip is one whose motion is not to be trusted (pipeline::warnings_of_motion).
/// @param dip  the dip that was measured; its profile is where the fit starts
/// Refuses what the dip refuses and (kInvalidArgument) fewer than four usable points 1 mm apart.
[[nodiscard]] Result<Outcome> fit(const mesh::Model& model, const pipeline::DipOptions& dip,
                                  const std::vector<Point>& points, const Options& options,
                                  const Context& context);

}  // namespace hydroprint::fit
