#pragma once

#include <vector>

#include "sim/registration/film_frame/matching.h"

namespace hydroprint::registration {

/// Whether markers stand to each other as the layout says: least squares of their places, each with
/// what its own fit leaves open, over the frame's pose. While they do not (chi-square beyond what
/// chance does once in 10000 times) and there are more than three, the one without which the others
/// agree best is left out.
/// @param matching  of at least three markers
[[nodiscard]] Matching agreeing(Matching matching, const std::vector<FoundMarker>& found,
                                const MarkerLayout& layout);

}  // namespace hydroprint::registration
