#pragma once

#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/mesh/surface.h"

namespace hydroprint::mesh {

/// Finds the corners of triangles that no film can reach because they lie inside another part of
/// the model, as in figures made of overlapping bodies. Counts the crossings of rays from a point
/// just outside each corner with the closed shells, with their signs. Open shells hide nothing.
/// @return see Surface::inner
[[nodiscard]] Result<std::vector<CornerSet>> inner_corners(const Surface& surface,
                                                           const Context& context);

}  // namespace hydroprint::mesh
