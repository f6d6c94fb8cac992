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

/// The result for a measured point. Places on the film are printed ones, in F, mm.
struct PointResult {
  Point point;
  Eigen::Vector2d before_mm;  ///< point landing there with the starting profile; NaN: none
  Eigen::Vector2d after_mm;   ///< with the fitted profile
  std::string left_out;       ///< why it does not count; empty: it counts
  bool is_outlier = false;    ///< its residual lies beyond 4 robust standard deviations

  [[nodiscard]] bool is_used() const { return left_out.empty(); }
};

struct Outcome {
  film::Profile profile;         ///< the starting profile with the fitted parameters
  Pose X_FO = Pose::Identity();  ///< as used: lowest point on the water, z = 0
  std::vector<Estimate> estimates;
  Eigen::MatrixXd correlation;  ///< of the estimates, in their order
  std::vector<Undetermined> undetermined;
  std::vector<PointResult> points;
  double rms_before_mm = 0, rms_after_mm = 0;  ///< of the used points' distances on the film
  double residual_sigma_mm = 0;                ///< standard deviation of one coordinate
  double discretisation_mm = 0;  ///< rms change of the prediction with finer meshes and steps
  int degrees_of_freedom = 0;
  double t_quantile = 0;  ///< Student's, of two-sided intervals
  int iterations = 0, dips = 0;
  bool settled = true;
  Warnings warnings;
};

/// Fits the film profile to a measured dip, using the quasistatic sheet of section 4.3. Least
/// squares of (predicted - measured) printed point, mm, with 95 % intervals. Parameters that the
/// points do not determine keep their value in `dip.profile` and are listed. Warns if the dip's
/// motion cannot be trusted (pipeline::warnings_of_motion).
/// @param dip  the measured dip; the fit starts with its profile
/// Fails as the dip does, and with kInvalidArgument for fewer than four usable points 1 mm apart.
[[nodiscard]] Result<Outcome> fit(const mesh::Model& model, const pipeline::DipOptions& dip,
                                  const std::vector<Point>& points, const Options& options,
                                  const Context& context);

}  // namespace hydroprint::fit
