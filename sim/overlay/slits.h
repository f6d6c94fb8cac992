#pragma once

#include "sim/overlay/outlines.h"

namespace hydroprint::overlay {

/// Makes gaps narrower than `width_mm` solid: between two outlines, and between parts of one
/// outline that are at least ten widths apart along it. The outlines change only there.
/// sim/waterline/README.md states the rule.
[[nodiscard]] Region close_slits(Region region, double width_mm);

/// Returns for each outline whether it vanishes because it is, or lies in, a hole whose mean width
/// (twice its area per length of its edges) is below `width_mm`.
[[nodiscard]] std::vector<char> lies_in_slit(const Region& region, double width_mm);

}  // namespace hydroprint::overlay
