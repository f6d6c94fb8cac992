#pragma once

#include <vector>

#include "sim/scan/cloud.h"

namespace hydroprint::registration {

/// The points of a cloud that are chosen, in pieces: neighbours in the image (eight around) that
/// are at most `jump_mm` apart belong together. Largest piece first.
[[nodiscard]] std::vector<std::vector<int>> segments(const scan::Cloud& cloud,
                                                     const std::vector<bool>& chosen,
                                                     double jump_mm);

}  // namespace hydroprint::registration
