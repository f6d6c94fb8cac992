#pragma once

#include <functional>

#include "sim/registration/camera/sightings.h"
#include "sim/scan/fixed_pattern.h"

namespace hydroprint::registration {

/// Computes the camera's fixed pattern from the residuals of the views of a board.
/// @param sightings   sorted by patch
/// @param row_of      returns the SightingRow of a sighting
/// @param covariance  of all unknowns: the lens in units of its prior standard deviations, then the
///                    pose of each view
/// @param spread      ratio of the sightings' spread to their noise
/// @param empty       an unknown pattern with the same image size and patch size
[[nodiscard]] scan::FixedPattern learn_pattern(
    const std::vector<Sighting>& sightings,
    const std::function<SightingRow(const Sighting&)>& row_of, const Eigen::MatrixXd& covariance,
    double spread, scan::FixedPattern empty);

}  // namespace hydroprint::registration
