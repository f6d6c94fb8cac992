#pragma once

#include "sim/mesh/model.h"

namespace hydroprint::sample {

/// Returns a sphere around the origin, made from an icosahedron by halving all edges `subdivisions`
/// times. It is closed, has 20 * 4^subdivisions triangles that face outward, and no texture
/// coordinates. The icosahedron stands on a corner, so that (0, 0, -radius) is a vertex.
/// @param subdivisions  0 to 9
[[nodiscard]] mesh::Model icosphere(double radius_mm, int subdivisions);

}  // namespace hydroprint::sample
