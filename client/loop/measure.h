#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "client/loop/draws.h"
#include "client/loop/surface_map.h"

namespace hydroprint::loop {

/// Displacements of the cross-points from their intended places, O. The cross-points and their
/// order are always the same; NaN if the film point lands nowhere.
using CrossErrors = std::vector<Eigen::Vector3d>;

/// Computes the displacement of each cross-point (section 7.1). Board: lines 10 mm apart on the
/// lower face. Sphere: meridians and parallels 15 degrees apart, down to the equator.
/// @param plan   from which the film image was made
/// @param truth  of the actual dip
/// @param as     film placement and printer scale, which shift points on the film
[[nodiscard]] CrossErrors cross_errors(const Body& body, const SurfaceMap& plan,
                                       const SurfaceMap& truth, const Truth& as);

/// Lengths, mm, of the displacements that are not NaN.
[[nodiscard]] std::vector<double> lengths_mm(const CrossErrors& errors);

/// Number of cross-points that land nowhere.
[[nodiscard]] int lost(const CrossErrors& errors);

/// The value that a share `share` of the values does not exceed; 0 if there are no values.
[[nodiscard]] double quantile(std::vector<double> values, double share);

/// The result for one pose. Each error includes the sources of the one before it.
struct Round {
  Truth truth;
  double turn_off_deg = 0;    ///< error of the calibrated orientation
  double shift_off_mm = 0;    ///< horizontal error of the object's centre
  double contact_off_mm = 0;  ///< error of first contact
  double stated_p95_mm = 0;   ///< registration error, as the calibration states it
  CrossErrors numerics;       ///< dipped as calibrated, printed as planned
  CrossErrors calibration;    ///< also with the true pose
  CrossErrors motion;         ///< also with the actual motion of the axis
  CrossErrors placement;      ///< also with film placement and printer scale: the total
  std::vector<std::string> jobs;
  std::vector<std::string> pictures;  ///< files beside the report
};

/// Limit for the 95th percentile over poses and cross-points, mm.
[[nodiscard]] double bound_mm(const Body& body);

/// Concatenates the errors of all rounds.
[[nodiscard]] CrossErrors pooled(const std::vector<Round>& rounds, CrossErrors Round::*stage);

/// A stage's share of the squared error. The numerator is the sum, over cross-points, of the step
/// that the stage adds, projected on the whole error. The denominator is the sum of the squared
/// whole errors. The shares sum to 1; a stage that offsets others has a negative share.
[[nodiscard]] double share(const std::vector<Round>& rounds, CrossErrors Round::*before,
                           CrossErrors Round::*stage);

}  // namespace hydroprint::loop
