#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace hydroprint::mesh {

/// Cuts a polygon into triangles that tile it: a fan from its first corner where every triangle of
/// the fan looks the polygon's way, else by clipping ears (concave polygons). Polygons that cross
/// themselves or are not flat get some tiling with the same boundary.
/// @param polygon  at least three indices into points
/// @return polygon.size() - 2 triples of positions in `polygon`, in its own sense of rotation
[[nodiscard]] std::vector<std::array<int, 3>> triangulate(
    const std::vector<Eigen::Vector3d>& points, std::span<const int> polygon);

}  // namespace hydroprint::mesh
