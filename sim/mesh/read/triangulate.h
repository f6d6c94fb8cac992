#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace hydroprint::mesh {

/// Splits a polygon into triangles that tile it. Uses a fan from the first corner if all its
/// triangles have the polygon's orientation, otherwise ear clipping (concave polygons). For
/// polygons that are self-intersecting or not planar, the tiling is arbitrary but has the same
/// boundary.
/// @param polygon  at least three indices into points
/// @return polygon.size() - 2 triples of positions in `polygon`, in its own orientation
[[nodiscard]] std::vector<std::array<int, 3>> triangulate(
    const std::vector<Eigen::Vector3d>& points, std::span<const int> polygon);

}  // namespace hydroprint::mesh
