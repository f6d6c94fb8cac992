#pragma once

#include "sim/registration/film_frame/film_frame.h"

namespace hydroprint::registration {

/// Height of the water's surface in the film frame, and its standard error.
struct WaterLevel {
  double z_mm = 0;
  double sigma_mm = 0;
  std::size_t points = 0;
};

/// Computes the mean height of the points near z = 0 over the film. Its error includes noise, the
/// covariance of the film frame and that of the camera. Returns kFailedPrecondition (NO_WATER) if
/// there are fewer than 200 points within 15 mm of z = 0.
/// @param half_film_mm  half of the film's width and height
[[nodiscard]] Result<WaterLevel> water_level(const scan::Cloud& cloud, const FilmFrame& frame,
                                             const Eigen::Vector2d& half_film_mm);

}  // namespace hydroprint::registration
