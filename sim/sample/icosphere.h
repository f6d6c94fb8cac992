#pragma once

#include "sim/mesh/model.h"

namespace hydroprint::sample {

/// A sphere round the origin from an icosahedron whose faces are halved `subdivisions` times: 20 *
/// 4^subdivisions triangles, closed, looking outward, without texture coordinates. The icosahedron
/// stands on a corner, so that (0, 0, -radius) is a vertex.
/// @param subdivisions  0 to 9
[[nodiscard]] mesh::Model icosphere(double radius_mm, int subdivisions);

}  // namespace hydroprint::sample
