#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/waterline/body.h"
#include "sim/waterline/schedule.h"

namespace hydroprint::waterline {

/// Capillary length of water, √(γ / ρg) with γ = 0.072 N/m. Within this distance of an edge,
/// surface tension bends the water surface.
inline constexpr double kCapillaryLength_mm = 2.7;

/// A level face that faces down and meets the water all at once, so that air is caught under it.
struct LevelFace {
  double immersion_mm = 0;
  Eigen::Vector2d place_mm = Eigen::Vector2d::Zero();  ///< a point on it near its centre, in F
  double area_mm2 = 0;
};

/// Finds the level faces that are wide enough to hold a bubble. Water bends around the edges of
/// narrower ones and drives the air out: those with a mean width (twice the area divided by the
/// perimeter) below two capillary lengths.
/// @param counted    for each triangle: 1 if it belongs to the outer surface and meets film
/// @param slope_rad  faces within this angle of horizontal are level
/// @return the faces, largest first
[[nodiscard]] std::vector<LevelFace> find_level_faces(
    const Body& body, const std::vector<char>& counted,
    double slope_rad = ScheduleOptions{}.shelf_slope_rad);

}  // namespace hydroprint::waterline
