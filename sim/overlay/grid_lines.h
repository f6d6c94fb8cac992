#pragma once

#include <Eigen/Core>
#include <array>
#include <compare>
#include <cstdint>
#include <vector>

namespace hydroprint::overlay {

/// A point of the grid on which regions are computed, in units of 1e-6 mm.
struct GridPoint {
  std::int64_t x = 0, y = 0;
  friend auto operator<=>(const GridPoint&, const GridPoint&) = default;
};

/// The area of one square of the grid, mm2.
inline constexpr double kGridSquare_mm2 = 1e-12;

[[nodiscard]] GridPoint to_grid(const Eigen::Vector2d& point_mm);
[[nodiscard]] Eigen::Vector2d to_mm(const GridPoint& point);

/// Returns 1 if p, q, r turn left, -1 if they turn right, 0 if they lie on one straight line.
[[nodiscard]] int turn(const GridPoint& p, const GridPoint& q, const GridPoint& r);

/// A straight line between two grid points, a < b, with the net number of curves of each of two
/// groups that run from a to b. The winding number of a group is this much larger on its left.
struct GridLine {
  GridPoint a, b;
  std::array<int, 2> passes = {0, 0};
};

/// Appends the line from `from` to `to`, as part of a curve of the given group (0 or 1).
void add_line(std::vector<GridLine>& lines, const GridPoint& from, const GridPoint& to, int group);

/// Splits lines where they meet, so that they share nothing but end points afterwards. Equal lines
/// become one, and lines whose passes add up to zero vanish. New points are rounded to the grid.
/// @return sorted by a, then b
[[nodiscard]] std::vector<GridLine> split_at_meetings(std::vector<GridLine> lines);

}  // namespace hydroprint::overlay
