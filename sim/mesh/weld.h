#pragma once

#include <Eigen/Core>
#include <vector>

namespace hydroprint::mesh {

/// Lengths below this fraction of the bounding box's diagonal count as zero: closer points are
/// welded, and triangles with a smaller height count as degenerate.
inline constexpr double kNothing = 1e-9;

/// Returns the diagonal of the points' bounding box; 0 if there are no points.
[[nodiscard]] double diagonal(const std::vector<Eigen::Vector3d>& points);

/// Returns the length, mm, below which lengths between these points count as zero: kNothing of the
/// diagonal, but at least four steps of a double at the largest coordinate, for models far from the
/// origin.
[[nodiscard]] double nothing_mm(const std::vector<Eigen::Vector3d>& points);

/// Returns the centre of the points' bounding box if it lies more than 10 m and ten times the box's
/// longest side from the origin, as in scans in map coordinates; else the origin. Computations in
/// floats must be relative to it.
[[nodiscard]] Eigen::Vector3d far_centre_mm(const std::vector<Eigen::Vector3d>& points);

/// Finds coincident points. Points are processed in order; each joins the first earlier
/// representative within `tolerance`, or becomes a representative itself. Takes time linear in the
/// number of points.
/// @return for each point, its representative (itself if none is near)
[[nodiscard]] std::vector<int> weld_points(const std::vector<Eigen::Vector3d>& points,
                                           double tolerance);

/// Returns true if the height of triangle abc over its longest side is below `tolerance`.
[[nodiscard]] bool is_degenerate(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                 const Eigen::Vector3d& c, double tolerance);

}  // namespace hydroprint::mesh
