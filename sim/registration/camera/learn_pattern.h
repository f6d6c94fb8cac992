#pragma once

#include <functional>

#include "sim/registration/camera/sightings.h"
#include "sim/scan/fixed_pattern.h"

namespace hydroprint::registration {

/// The camera's fixed pattern by what the views of a board leave unexplained.
/// @param sightings   sorted by patch
/// @param row_of      the row of a sighting
/// @param covariance  of all unknowns: of the lens, in units of what was believed, then of each
/// pose
/// @param spread      how much farther off sightings are than noise explains
/// @param empty       nothing known, of the image's size and the noise's squares
[[nodiscard]] scan::FixedPattern learn_pattern(
    const std::vector<Sighting>& sightings,
    const std::function<SightingRow(const Sighting&)>& row_of, const Eigen::MatrixXd& covariance,
    double spread, scan::FixedPattern empty);

}  // namespace hydroprint::registration
