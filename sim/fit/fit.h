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
  std::string points_name = "points";  ///< name of the points' file, for messages
};

/// The result for a measured point. Positions on the film are those of the printed image, in F, mm.
struct PointResult {
  Point point;
  /// The film point that lands there with the starting profile; NaN: none.
  Eigen::Vector2d before_mm;
  Eigen::Vector2d after_mm;  ///< the film point that lands there with the fitted profile
  std::string left_out;      ///< why the point is not used; empty: it is used
  bool is_outlier = false;   ///< its residual lies beyond 4 robust standard deviations

  [[nodiscard]] bool is_used() const { return left_out.empty(); }
};

struct Outcome {
  film::Profile profile;         ///< the starting profile with the fitted parameters
  Pose X_FO = Pose::Identity();  ///< pose as used: lowest point on the water, z = 0
  std::vector<Estimate> estimates;
  Eigen::MatrixXd correlation;  ///< correlations of the estimates, in their order
  std::vector<Undetermined> undetermined;
  std::vector<PointResult> points;
  /// Rms distance, on the film, between predicted and measured positions of the used points.
  double rms_before_mm = 0, rms_after_mm = 0;
  double residual_sigma_mm = 0;  ///< standard deviation of one coordinate of the residuals
  double discretisation_mm = 0;  ///< rms change of the prediction with finer meshes and steps
  int degrees_of_freedom = 0;
  double t_quantile = 0;  ///< quantile of Student's t for two-sided intervals
  int iterations = 0, dips = 0;
  bool settled = true;
  Warnings warnings;
};

/// Fits the film profile to a measured dip, using the quasistatic sheet of section 4.3. Minimises
/// the squares of predicted minus measured printed positions, mm; intervals are 95 %. Parameters
/// that the points do not determine keep their values in `dip.profile` and are listed. Warns if the
/// computed motion is unreliable (pipeline::warnings_of_motion). Returns the errors of the dip, and
/// kInvalidArgument for fewer than four usable points 1 mm apart.
/// @param dip  the measured dip; the fit starts with its profile
[[nodiscard]] Result<Outcome> fit(const mesh::Model& model, const pipeline::DipOptions& dip,
                                  const std::vector<Point>& points, const Options& options,
                                  const Context& context);

}  // namespace hydroprint::fit
