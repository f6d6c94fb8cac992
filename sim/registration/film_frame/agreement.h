#pragma once

#include <vector>

#include "sim/registration/film_frame/matching.h"

namespace hydroprint::registration {

/// Checks the markers' relative positions against the layout. Fits the frame's pose to their
/// positions by least squares, with the covariance of each marker's own fit. The markers disagree
/// if chi-square exceeds its 99.99 % quantile. While they disagree and there are more than three,
/// drops the marker without which the others agree best.
/// @param matching  of at least three markers
[[nodiscard]] Matching agreeing(Matching matching, const std::vector<FoundMarker>& found,
                                const MarkerLayout& layout);

}  // namespace hydroprint::registration
