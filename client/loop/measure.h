#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "client/loop/draws.h"
#include "client/loop/surface_map.h"

namespace hydroprint::loop {

/// Displacements of the cross-points from their intended places, O. The cross-points and their
/// order are always the same; NaN if the film point does not land on the object.
using CrossErrors = std::vector<Eigen::Vector3d>;

/// Computes the displacement of each cross-point (section 7.1). Board: lines 10 mm apart on the
/// lower face. Sphere: meridians and parallels 15 degrees apart, down to the equator.
/// @param plan   result of the simulation from which the film image was made
/// @param truth  result of the actual dip
/// @param as     film placement and printer scale, which shift points on the film
[[nodiscard]] CrossErrors cross_errors(const Body& body, const SurfaceMap& plan,
                                       const SurfaceMap& truth, const Truth& as);

/// Returns the lengths, mm, of the displacements that are not NaN.
[[nodiscard]] std::vector<double> lengths_mm(const CrossErrors& errors);

/// Returns the number of cross-points that do not land.
[[nodiscard]] int lost(const CrossErrors& errors);

/// Returns the quantile of the values for the probability `share`; 0 if there are no values.
[[nodiscard]] double quantile(std::vector<double> values, double share);

/// The result for one pose. Each of the CrossErrors includes the sources of error of those before
/// it.
struct Round {
  Truth truth;
  double turn_off_deg = 0;    ///< error of the calibrated orientation
  double shift_off_mm = 0;    ///< horizontal error of the object's centre
  double contact_off_mm = 0;  ///< error of first contact
  double stated_p95_mm = 0;   ///< registration error as stated in the calibration
  CrossErrors numerics;       ///< dipped as calibrated, printed as planned
  CrossErrors calibration;    ///< also with the true pose
  CrossErrors motion;         ///< also with the actual motion of the axis
  CrossErrors placement;      ///< also with film placement and printer scale: the total
  std::vector<std::string> jobs;
  std::vector<std::string> pictures;  ///< files beside the report
};

/// Returns the limit for the 95th percentile of the placement error over poses and cross-points,
/// mm.
[[nodiscard]] double bound_mm(const Body& body);

/// Concatenates the errors of all rounds.
[[nodiscard]] CrossErrors pooled(const std::vector<Round>& rounds, CrossErrors Round::*stage);

/// Returns the fraction of the total squared error that a stage contributes: sum(dot(step, total))
/// / sum(dot(total, total)) over the cross-points, where `step` is the error that the stage adds.
/// The fractions sum to 1; the fraction is negative for a stage that cancels part of the error.
[[nodiscard]] double share(const std::vector<Round>& rounds, CrossErrors Round::*before,
                           CrossErrors Round::*stage);

}  // namespace hydroprint::loop
