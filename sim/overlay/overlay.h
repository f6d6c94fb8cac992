#pragma once

#include <array>
#include <vector>

#include "sim/overlay/grid_lines.h"

namespace hydroprint::overlay {

/// The plane divided by curves of two groups into triangles, each with its winding numbers. Edge i
/// of a triangle runs from corner i + 1 to corner i + 2 (modulo 3).
struct Overlay {
  static constexpr int kOutside = -1;
  struct Triangle {
    std::array<int, 3> corners;     ///< indices of points, counter-clockwise
    std::array<int, 3> neighbours;  ///< at each edge; kOutside: the unbounded rest of the plane
    std::array<int, 2> windings = {0, 0};  ///< of each group
  };
  std::vector<GridPoint> points;
  std::vector<Triangle> triangles;  ///< cover the convex hull of the points
};

/// Computes the constrained Delaunay triangulation of lines that share nothing but end points (as
/// split_at_meetings() returns them), and the winding numbers of its triangles.
[[nodiscard]] Overlay triangulate(const std::vector<GridLine>& lines);

/// Returns the area of a triangle, mm2.
[[nodiscard]] double area_mm2(const Overlay& overlay, const Overlay::Triangle& triangle);

}  // namespace hydroprint::overlay
