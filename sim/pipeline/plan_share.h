#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/pose.h"
#include "sim/mesh/surface.h"
#include "sim/pipeline/division.h"

namespace hydroprint::pipeline {

/// What a plan of several dips states about one of them.
struct PlanShare {
  int dip = 1;             ///< from 1
  double blend_mm = 0;     ///< see PlanOptions
  std::vector<Pose> X_FO;  ///< planned pose of each dip, as used
  /// The surface that was divided.
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3i> triangles;
  plan::Stretch stretch;  ///< per dip and point, under Stokes flow; NaN where no film arrives
};

/// Divides the surface exactly as the plan did. Returns kInvalidArgument for a surface other than
/// the plan's, and the errors of divide().
[[nodiscard]] Result<Division> divide_as_planned(const mesh::Surface& surface,
                                                 const PlanShare& share, const Context& context);

/// How a dip differs from its plan.
struct PlanDeviation {
  double turn_rad = 0;  ///< angle between the two orientations
  /// Distance of the middle of the object's bounding box, along x and y of frame F.
  Eigen::Vector2d shift_mm = {0, 0};
  double lost_share = 0;  ///< share of the dip's region that its film does not reach, in [0, 1]
  /// Largest distance of the dip's seam, as least stretch would place it now, from the planned one;
  /// infinity if none was planned.
  double seam_shift_mm = 0;
};

/// @param division  of divide_as_planned()
/// @param X_FO      pose of this dip
/// @param stretch   of this dip at the points of the surface under Stokes flow; NaN where no film
///                  arrives
[[nodiscard]] Result<PlanDeviation> deviation_from(const PlanShare& share, const Division& division,
                                                   const mesh::Surface& surface, const Pose& X_FO,
                                                   const std::vector<double>& stretch,
                                                   const Context& context);

/// Returns the warnings of a dip that differs too much from its plan, with the remedy:
/// plan_pose_off beyond 5 degrees, or 10 mm along x or y; plan_reach_lost beyond 1 % of the dip's
/// region; plan_seam_moved beyond the blend width.
[[nodiscard]] Warnings warnings_of_deviation(const PlanDeviation& deviation,
                                             const PlanShare& share);

}  // namespace hydroprint::pipeline
