#pragma once

#include <vector>

#include "sim/plan/borders.h"
#include "sim/plan/fragments.h"

namespace hydroprint::plan {

/// Lets small pieces of a region join a neighbour, and sets Fragment::dip accordingly. A piece is a
/// connected set of fragments of one dip. Each piece smaller than `min_area_mm2`, the smallest
/// first, joins the adjacent piece with the longest common border among those whose dip reaches all
/// of it. This is repeated until no piece changes. Pieces without such a neighbour stay, and so do
/// those that no dip reaches.
/// @return for each fragment, the number of its piece: pieces count from 0 in the order of their
///         first fragments
[[nodiscard]] std::vector<int> join_small_pieces(const Facets& facets, const Borders& borders,
                                                 double min_area_mm2, Fragments& fragments);

}  // namespace hydroprint::plan
