#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "sim/overlay/outlines.h"

namespace hydroprint::overlay {

/// Least distance along one outline, in widths of a slit, between the two sides of a slit.
inline constexpr double kLeastWayRound = 10;

/// A straight line of an outline.
struct Side {
  int a, b;  ///< indices of its end points
  Eigen::Vector2d a_mm, b_mm;
  int outline;
  double along_mm;  ///< from the outline's first point to a_mm
  /// The parts that are close to another side, as shares of the length.
  std::vector<std::pair<double, double>> near_parts = {};

  [[nodiscard]] double length_mm() const { return (b_mm - a_mm).norm(); }
  [[nodiscard]] Eigen::Vector2d at(double t) const { return a_mm + t * (b_mm - a_mm); }
};

/// The lines of all outlines of a region.
struct Sides {
  std::vector<Side> sides;
  std::vector<double> lengths_mm;  ///< of the outlines
};

/// Where a point lies: on which outline, and how far along it.
struct Place {
  static constexpr int kSeveral = -1;  ///< outlines touch here
  static constexpr int kNone = -2;
  int outline = kNone;
  double along_mm = 0;
};

[[nodiscard]] Sides sides_of(const Region& region);

/// Returns the place of each point of the region's overlay.
[[nodiscard]] std::vector<Place> places_of(const Region& region, const Sides& sides);

/// Adds the near parts of sides that face each other across less than the width and belong to two
/// outlines, or are far apart along one.
/// @return whether there are any
bool add_facing_parts(double width_mm, Sides& sides);

/// Adds the near parts of sides at points at which outlines touch, up to the width from them.
/// @return whether there are any
bool add_touching_parts(const std::vector<Place>& places, double width_mm, Sides& sides);

/// Returns the lines of all sides: near parts in steps of at most the width, and the rest whole.
[[nodiscard]] std::vector<GridLine> stepped_lines(double width_mm, Sides sides);

/// Returns the distance between a point and a straight line from a to b, mm.
[[nodiscard]] double distance_mm(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                                 const Eigen::Vector2d& b);

}  // namespace hydroprint::overlay
