#pragma once

#include <functional>
#include <vector>

#include "sim/waterline/cross_section.h"

namespace hydroprint::waterline {

struct Waterline;

/// Returns the cross-section at an immersion, mm.
using SectionAt = std::function<CrossSection(double)>;

/// Finds the holes of cross-sections from which air cannot escape: no way through air leads from
/// the hole to the surroundings without going below its waterline. Water then stays out of them,
/// and the film with it. The compression of the air is neglected: it is 1 % of its volume for
/// 100 mm of water.
///
/// Goes from the top down and unites air that is connected. Air at two neighbouring waterlines is
/// connected where it overlaps when seen from above. Waterlines that are too far apart to tell are
/// divided. Where even that does not tell, the air counts as connected, so that film is not taken
/// away by mistake.
/// @param lines       the waterlines from first contact to the top of the object; there is only
///                    air above the last
/// @param section_at  computes the cross-section between two of them
/// @return for each waterline and each of its loops: 1 if the loop is the edge of such a hole
[[nodiscard]] std::vector<std::vector<char>> holes_with_trapped_air(
    const std::vector<const Waterline*>& lines, const SectionAt& section_at);

}  // namespace hydroprint::waterline
