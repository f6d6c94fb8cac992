#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/film/outline.h"
#include "sim/fit/fit.h"
#include "sim/fit/spots.h"
#include "sim/waterline/body.h"

namespace hydroprint::fit {

/// Returns why a point cannot be used because of its position; empty if it can.
[[nodiscard]] std::string geometric_objection(const Point& point, const Spot& spot,
                                              const waterline::Body& body,
                                              const film::Outline& outline);

/// Returns an error if fewer than four used points lie 1 mm apart on the film. The message names
/// the main reason why other points are not used.
[[nodiscard]] Status check_enough(const std::vector<PointResult>& points, const std::string& name);

/// Marks the used points whose residual after the fit lies beyond 4 robust standard deviations.
/// @return the number of newly marked points
int mark_outliers(std::vector<PointResult>& points, double floor_mm);

}  // namespace hydroprint::fit
