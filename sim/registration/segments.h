#pragma once

#include <vector>

#include "sim/scan/cloud.h"

namespace hydroprint::registration {

/// Splits the chosen points of a cloud into connected pieces, largest first. Points within two
/// pixels of each other are connected if they are at most `jump_mm` apart.
[[nodiscard]] std::vector<std::vector<int>> segments(const scan::Cloud& cloud,
                                                     const std::vector<bool>& chosen,
                                                     double jump_mm);

}  // namespace hydroprint::registration
