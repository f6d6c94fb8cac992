#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "client/loop/draws.h"
#include "client/loop/surface_map.h"

namespace hydroprint::loop {

/// By how much cross-points land off where they belong, O; always the same cross-points in the same
/// order, NaN for one whose film lands nowhere.
using CrossErrors = std::vector<Eigen::Vector3d>;

/// How far the picture's cross-points land from where they belong (section 7.1): on the board's
/// lower face the lines 10 mm apart, on the sphere to its equator the meridians and parallels 15
/// degrees apart.
/// @param plan   by which the film image was made
/// @param truth  by which it was dipped
/// @param as     where what belongs to a film point really lies on the film: film placement and
///               printer scale
[[nodiscard]] CrossErrors cross_errors(const Body& body, const SurfaceMap& plan,
                                       const SurfaceMap& truth, const Truth& as);

/// Lengths of those that land, mm.
[[nodiscard]] std::vector<double> lengths_mm(const CrossErrors& errors);

/// How many land nowhere.
[[nodiscard]] int lost(const CrossErrors& errors);

/// So that a share of `share` is not above it; 0 of none.
[[nodiscard]] double quantile(std::vector<double> values, double share);

/// What one pose came to. Each of the errors holds what the one before it holds, and more.
struct Round {
  Truth truth;
  double turn_off_deg = 0;    ///< of the calibrated pose
  double shift_off_mm = 0;    ///< of the middle of the object, sideways
  double contact_off_mm = 0;  ///< of first contact
  double stated_p95_mm = 0;   ///< of the registration error, by the calibration itself
  CrossErrors numerics;       ///< dipped as calibrated, printed as planned
  CrossErrors calibration;    ///< and at the true pose
  CrossErrors motion;         ///< and along the axis as driven
  CrossErrors placement;      ///< and with the film and the printer's scale off: all there is
  std::vector<std::string> jobs;
  std::vector<std::string> pictures;  ///< files beside the report
};

/// What the 95th percentile over poses and cross-points may be at most, mm.
[[nodiscard]] double bound_mm(const Body& body);

/// All errors of all rounds, one after the other.
[[nodiscard]] CrossErrors pooled(const std::vector<Round>& rounds, CrossErrors Round::*stage);

/// The part of the squared error that comes with a stage: the sum, over cross-points, of the step
/// that it adds along the whole error, over that of the whole errors squared. The stages' sum to 1;
/// one that works against the others is negative.
[[nodiscard]] double share(const std::vector<Round>& rounds, CrossErrors Round::*before,
                           CrossErrors Round::*stage);

}  // namespace hydroprint::loop
